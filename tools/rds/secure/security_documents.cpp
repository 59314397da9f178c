// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/security_documents.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/bus/security.hpp"
#include "common/topics/topics.hpp"

namespace rds::secure {
namespace {

std::string all_domains() {
  return fmt::format("<domains><id_range><min>0</min><max>{}</max></id_range></domains>",
                     bus::kHighestSecuredDomain);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

/// UTC, without a zone: one vendor knows no other form.
std::string date(std::chrono::system_clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

/// Every participant takes part in ROS 2's graph.
std::string topics(const std::string& element, const std::vector<std::string>& names) {
  std::string text =
      "      <" + element + ">\n        <topics>\n          <topic>ros_discovery_info</topic>\n";
  for (const std::string& name : names) text += "          <topic>rt/" + escaped(name) + "</topic>\n";
  return text + "        </topics>\n      </" + element + ">\n";
}

/// @param metadata,data  what is encrypted of this topic: ENCRYPT or NONE.
std::string topic_rule(const std::string& expression, const std::string& metadata, const std::string& data) {
  return fmt::format(R"(      <topic_rule>
        <topic_expression>{}</topic_expression>
        <enable_discovery_protection>true</enable_discovery_protection>
        <enable_liveliness_protection>true</enable_liveliness_protection>
        <enable_read_access_control>true</enable_read_access_control>
        <enable_write_access_control>true</enable_write_access_control>
        <metadata_protection_kind>{}</metadata_protection_kind>
        <data_protection_kind>{}</data_protection_kind>
      </topic_rule>
)",
                     escaped(expression), metadata, data);
}

/// The first rule that fits holds.
std::string topic_rules(std::vector<std::string> pictures) {
  pictures.emplace_back(topics::kKeyframeImages.name);
  std::string rules;
  for (const std::string& topic : pictures) rules += topic_rule("rt/" + topic, "NONE", "ENCRYPT");
  return rules + topic_rule("*", "ENCRYPT", "NONE");
}

}  // namespace

std::string governance(const std::vector<std::string>& camera_topics) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
<domain_access_rules>
  <domain_rule>
    {}
    <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
    <enable_join_access_control>true</enable_join_access_control>
    <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
    <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
    <rtps_protection_kind>NONE</rtps_protection_kind>
    <topic_access_rules>
{}    </topic_access_rules>
  </domain_rule>
</domain_access_rules>
</dds>
)",
                     all_domains(), topic_rules(camera_topics));
}

std::string permissions(const Role& role, const std::string& subject, const Validity& validity) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170801/omg_shared_ca_permissions.xsd">
<permissions>
  <grant name="{}">
    <subject_name>{}</subject_name>
    <validity>
      <not_before>{}</not_before>
      <not_after>{}</not_after>
    </validity>
    <allow_rule>
      {}
{}{}    </allow_rule>
    <default>DENY</default>
  </grant>
</permissions>
</dds>
)",
                     role.name, subject, date(validity.from), date(validity.until), all_domains(),
                     topics("publish", role.publishes), topics("subscribe", role.subscribes));
}

std::string access_list(const std::vector<Role>& roles) {
  nlohmann::json list;
  for (const Role& role : roles) {
    if (role.relays)
      list[role.name] = {{"relays", true}};
    else
      list[role.name] = {{"publishes", role.publishes}, {"subscribes", role.subscribes}};
  }
  return list.dump(2) + "\n";
}

}  // namespace rds::secure
