// SPDX-License-Identifier: Apache-2.0
#include "common/topics/table.hpp"

#include <algorithm>

#include "common/bus/type_ops.hpp"
#include "common/topics/topics.hpp"

namespace rds::topics {
namespace {

template <class Message>
Row row(const Topic<Message>& topic) {
  return {topic.name, bus::type_ops<Message>().ros_name, topic.writers, topic.readers, topic.is_global};
}

bool names(std::initializer_list<Endpoint> endpoints, Process process) {
  return std::ranges::any_of(endpoints,
                             [&](const Endpoint& endpoint) { return contains(endpoint.processes, process); });
}

}  // namespace

bool Row::is_written_by(Process process) const {
  return names(writers, process);
}

bool Row::is_read_by(Process process) const {
  return names(readers, process);
}

const std::vector<Row>& table() {
  static const std::vector<Row> kTable =
      std::apply([](const auto&... topic) { return std::vector<Row>{row(topic)...}; }, kAllTopics);
  return kTable;
}

std::vector<std::string> written_by(Process process) {
  std::vector<std::string> names;
  for (const Row& row : table())
    if (row.is_written_by(process)) names.push_back(row.name);
  return names;
}

}  // namespace rds::topics
