// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/setting_comments.hpp"

#include <sstream>
#include <utility>
#include <vector>

namespace rds::service {
namespace {

/// Where a comment begins; npos without one. A '#' between quotes, or in the middle of a word, begins none.
std::size_t comment_begin(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#' && (i == 0 || line[i - 1] == ' ')) {
      return i;
    }
  }
  return std::string::npos;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \r") - first + 1);
}

}  // namespace

std::map<std::string, std::string> setting_comments(const std::string& yaml) {
  std::map<std::string, std::string> comments;
  std::vector<std::pair<std::size_t, std::string>> sections;  // indentation and name with a dot at its end
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = comment_begin(line);
    const std::size_t indentation = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    if (indentation == std::string::npos || colon == std::string::npos || begin < colon) continue;
    while (!sections.empty() && sections.back().first >= indentation) sections.pop_back();
    const std::string above = sections.empty() ? "" : sections.back().second;
    const std::string name = above + line.substr(indentation, colon - indentation);
    const std::string value = line.substr(colon + 1, begin == std::string::npos ? begin : begin - colon - 1);
    if (trimmed(value).empty())
      sections.emplace_back(indentation, name + ".");
    else if (begin != std::string::npos)
      comments[name] = trimmed(line.substr(begin + 1));
  }
  return comments;
}

}  // namespace rds::service
