// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/frame_times.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "common/geometry/text_line.hpp"

namespace rds::evaluation {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line.ends_with('\r') ? line.substr(0, line.size() - 1) : line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

tl::expected<std::map<std::string, std::vector<double>>, std::string> read_csv_columns(
    const std::filesystem::path& file, const std::vector<std::string>& columns) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line))
    return tl::unexpected(
        fmt::format("{}: cannot be read, expected a first line of column names", file.string()));
  const auto names = cells_of(line);
  std::map<std::string, std::vector<double>> values;
  for (int number = 2; std::getline(in, line); ++number) {
    const auto cells = cells_of(line);
    if (cells.empty()) continue;
    for (const auto& column : columns) {
      const auto at = static_cast<std::size_t>(std::ranges::find(names, column) - names.begin());
      if (at == names.size())
        return tl::unexpected(fmt::format("{}:1: expected a column {}", file.string(), column));
      const auto value = at < cells.size() ? geometry::parse_number(cells[at]) : std::nullopt;
      if (!value)
        return tl::unexpected(fmt::format("{}:{}: expected a number as {}", file.string(), number, column));
      values[column].push_back(*value);
    }
  }
  return values;
}

}  // namespace rds::evaluation
