// SPDX-License-Identifier: Apache-2.0
#include "common/image/tum_list.hpp"

#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "common/geometry/stamp.hpp"
#include "common/geometry/text_line.hpp"

namespace rds::image {
namespace {

std::optional<TumListEntry> parse_line(const std::string& line, const std::filesystem::path& folder,
                                       int number) {
  const auto words = geometry::split_words(line);
  if (words.size() != 2) return std::nullopt;
  const auto stamp = geometry::parse_stamp_ns(words[0]);
  if (!stamp) return std::nullopt;
  return TumListEntry{*stamp, std::string(words[0]), folder / std::string(words[1]), number};
}

}  // namespace

tl::expected<TumList, std::string> read_tum_list(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file))
    return tl::unexpected(fmt::format("{}: cannot be read, expected a list of pictures", file.string()));
  TumList list;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (geometry::split_words(line).empty() || line.starts_with('#')) continue;
    auto entry = parse_line(line, file.parent_path(), number);
    if (!entry)
      return tl::unexpected(fmt::format("{}:{}: expected `timestamp filename`, found {}", file.string(),
                                        number, geometry::shown(line)));
    if (!list.entries.empty() && entry->stamp_ns < list.entries.back().stamp_ns)
      return tl::unexpected(fmt::format("{}:{}: stamp {} goes back, expected one after {}", file.string(),
                                        number, entry->stamp_text, list.entries.back().stamp_text));
    if (!list.entries.empty() && entry->stamp_ns == list.entries.back().stamp_ns)
      ++list.repeated;
    else
      list.entries.push_back(std::move(*entry));
  }
  if (list.entries.empty())
    return tl::unexpected(
        fmt::format("{}: lists no picture, expected lines `timestamp filename`", file.string()));
  return list;
}

}  // namespace rds::image
