// SPDX-License-Identifier: Apache-2.0
#include "common/bus/zenoh/zenoh_access.hpp"

#include <algorithm>

#include <fnmatch.h>
#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "common/bus/security_openssl.hpp"

namespace rds::bus::detail {
namespace {

using Texts = std::vector<std::string>;
using nlohmann::json;

/// Zenoh's form of a part of a topic's name: '*' alone stands for any number of parts, else for any text.
std::string chunk_of(const std::string& part) {
  if (part == "*") return "**";
  std::string chunk;
  for (const char c : part) chunk += c == '*' ? "$*" : std::string(1, c);
  return part.ends_with('*') ? chunk + "/**" : chunk;
}

/// All keys below a topic in any domain, with those (@adv) that stand for what is kept for late readers.
void append_keys(Texts& keys, const std::string& topic) {
  std::string key = "*";
  std::size_t start = 0;
  while (start <= topic.size()) {
    const std::size_t end = std::min(topic.find('/', start), topic.size());
    const std::string chunk = chunk_of(topic.substr(start, end - start));
    if (!(chunk == "**" && key.ends_with("**"))) key += "/" + chunk;
    start = end + 1;
  }
  if (!key.ends_with("**")) key += "/**";
  keys.push_back(key);
  keys.push_back(key + "/@adv/**");
}

Texts keys_of(const Texts& topics) {
  Texts keys;
  for (const std::string& topic : topics) append_keys(keys, topic);
  return keys;
}

/// The rules of one certificate's name, as the others apply them: what comes from it (ingress) and what goes
/// to it (egress).
class RulesOf {
 public:
  RulesOf(json& access, std::string name) : access_(access), name_(std::move(name)) {}

  void allow(const char* flow, const Texts& messages, const Texts& keys) {
    if (keys.empty()) return;
    const std::string id = name_ + "_" + std::to_string(rules_.size());
    access_["rules"].push_back({{"id", id},
                                {"permission", "allow"},
                                {"flows", {flow}},
                                {"messages", messages},
                                {"key_exprs", keys}});
    rules_.push_back(id);
  }
  void finish() {
    access_["subjects"].push_back({{"id", name_}, {"cert_common_names", {name_}}});
    access_["policies"].push_back({{"rules", rules_}, {"subjects", {name_}}});
  }

 private:
  json& access_;
  std::string name_;
  Texts rules_;
};

const Texts kSays{"put", "reply", "declare_queryable"};
const Texts kAsks{"declare_subscriber", "query"};
// Who is there. Tokens carry no data, and all who have a certificate may see them.
const Texts kIsThere{"liveliness_token", "declare_liveliness_subscriber", "liveliness_query"};
const Texts kTokens{"@ros2_lv/**", "**/@adv/**"};

}  // namespace

ZenohAccess::ZenohAccess(const Credentials& credentials) : credentials_(credentials) {
  const std::filesystem::path file = credentials.ca.parent_path() / kAccessFile;
  if (!exists(file))
    throw BusError(file.string() +
                   ": no such file, which Zenoh needs; make the folder anew with: rds secure init --force");
  const auto text = openssl::read_signed(file, credentials.ca, std::chrono::system_clock::now());
  if (!text) throw BusError(text.error());
  try {
    read(*text);
  } catch (const json::exception& e) {
    throw BusError(file.string() + ": is damaged: " + e.what());
  }
}

void ZenohAccess::read(const std::string& text) {
  const json list = json::parse(text);
  for (const auto& [name, role] : list.items())
    roles_[name] = {role.value("publishes", Texts{}), role.value("subscribes", Texts{}),
                    role.value("relays", false)};
}

json ZenohAccess::rules() const {
  json access{{"enabled", true},
              {"default_permission", "deny"},
              {"rules", json::array()},
              {"subjects", json::array()},
              {"policies", json::array()}};
  for (const auto& [name, role] : roles_) {
    const Texts everything{"**", "**/@adv/**"};
    const Texts says = role.relays ? everything : keys_of(role.publishes);
    const Texts hears = role.relays ? everything : keys_of(role.subscribes);
    RulesOf rules(access, name);
    rules.allow("ingress", kSays, says);
    rules.allow("ingress", kAsks, hears);
    rules.allow("egress", kSays, hears);
    rules.allow("egress", kAsks, says);
    for (const char* flow : {"ingress", "egress"}) rules.allow(flow, kIsThere, kTokens);
    rules.finish();
  }
  return access;
}

void ZenohAccess::check(const std::string& topic, bool publisher) const {
  const auto own = roles_.find(credentials_.identity);
  const auto fits = [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), topic.c_str(), 0) == 0;
  };
  if (own != roles_.end() &&
      std::ranges::any_of(publisher ? own->second.publishes : own->second.subscribes, fits))
    return;
  throw BusError("topic " + topic + ": a " + (publisher ? "publisher" : "subscription") + " is refused");
}

}  // namespace rds::bus::detail
