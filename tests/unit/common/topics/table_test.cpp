// SPDX-License-Identifier: Apache-2.0
#include "common/topics/table.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "common/topics/topics.hpp"

namespace rds::topics {
namespace {

using ::testing::HasSubstr;
using Names = std::set<std::string>;

struct Service {
  Process process;
  std::string folder;
};
const std::vector<Service> kFolders{{kTracker, "tracker"},         {kDetector, "detector"},
                                    {kTransformer, "transformer"}, {kMapper, "mapper"},
                                    {kLoopCloser, "loop_closer"},  {kViewer, "viewer"}};

std::vector<std::string> lines_of(const std::string& file) {
  std::ifstream in(std::string(RDS_SOURCE_DIR) + "/" + file);
  EXPECT_TRUE(in) << file;
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Topics in backticks; `/rds/odometry` is rds/odometry.
Names topics_in(const std::string& text) {
  static const std::regex kTopic("`/?((?:rds|camera)/[a-zA-Z0-9_/]+|tf|tf_static|diagnostics|odom|imu|initialpose)`");
  Names names;
  for (std::sregex_iterator m(text.begin(), text.end(), kTopic), end; m != end; ++m) names.insert((*m)[1]);
  return names;
}

/// Topics in the first column of the table with this heading.
Names listed(const std::string& readme, const std::string& heading) {
  Names names;
  bool inside = false;
  for (const std::string& line : lines_of(readme)) {
    if (line.starts_with("| " + heading + " |")) inside = true;
    if (!line.starts_with("|")) inside = false;
    if (inside) names.merge(topics_in(line.substr(0, line.find('|', 1))));
  }
  return names;
}

/// What every service does is told in common/service/README.md.
bool is_of_every_service(const Row& row) {
  return row.is_written_by(kServices) || row.is_read_by(kServices);
}

TEST(TopicTable, HasEachNameOnceAndWhoUsesIt) {
  Names names;
  for (const Row& row : table()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_NE(row.writers.size() + row.readers.size(), 0U) << row.name;
  }
}

TEST(TopicTable, RefusesProcessesThatItDoesNotName) {
  EXPECT_THROW(qos_of(kMapper, kColor.readers, kColor.name), std::logic_error);
  EXPECT_EQ(qos_of(kTracker, kBoxes.readers, kBoxes.name).depth, bus::kStream.depth);
}

TEST(TopicTable, IsThatOfTheServicesReadmes) {
  for (const auto& [process, folder] : kFolders) {
    Names written;
    Names read;
    for (const Row& row : table()) {
      if (is_of_every_service(row)) continue;
      if (row.is_written_by(process)) written.insert(row.name);
      if (row.is_read_by(process)) read.insert(row.name);
    }
    const std::string readme = "services/" + folder + "/README.md";
    EXPECT_EQ(listed(readme, "writes"), written) << readme;
    EXPECT_EQ(listed(readme, "reads"), read) << readme;
  }
}

/// "nav_msgs/Odometry" of "nav_msgs/msg/Odometry", without its package where the README leaves it out.
std::string short_type(const Row& row, const std::string& cell) {
  const std::string type = std::regex_replace(row.type, std::regex("/msg/"), "/");
  return cell.find('/') == std::string::npos ? type.substr(type.find('/') + 1) : type;
}

TEST(TopicTable, IsThatOfThePageForRos2) {
  std::size_t found = 0;
  for (const std::string& line : lines_of("docs/ros2.md")) {
    if (!line.starts_with("| `/")) continue;
    std::istringstream cells(line);
    std::string cell;
    std::vector<std::string> columns;
    while (std::getline(cells, cell, '|')) columns.push_back(cell);
    ASSERT_GE(columns.size(), 4U) << line;
    for (const std::string& name : topics_in(columns[1])) {
      const auto row = std::ranges::find(table(), name, &Row::name);
      ASSERT_NE(row, table().end()) << name;
      EXPECT_THAT(columns[2], HasSubstr(short_type(*row, columns[2])));
      const bus::Qos& qos = row->writers.begin()->qos;
      EXPECT_THAT(columns[3], HasSubstr(qos.transient_local ? "transient local" : "volatile")) << name;
      ++found;
    }
  }
  EXPECT_GE(found, 9U);
}

}  // namespace
}  // namespace rds::topics
