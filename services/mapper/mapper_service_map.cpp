// SPDX-License-Identifier: Apache-2.0
// The part of MapperService that saves the map and goes on from a saved one.
#include <fmt/format.h>

#include "common/map_file/saved_map.hpp"
#include "services/mapper/core/map_files.hpp"
#include "services/mapper/mapper_service.hpp"

namespace rds::mapper {

/// From a saved map, or from OctoMap's tree in a file.
tl::expected<void, std::string> MapperService::start_from(const std::filesystem::path& saved_map) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: cannot be mapped on: {}", saved_map.string(), why));
  };
  if (looks_like_tree(saved_map)) {
    auto tree = read_tree(saved_map);
    if (!tree) return tl::unexpected(tree.error());
    const auto started = mapper_.start_from(std::move(**tree));
    return started ? started : refuse(started.error());
  }
  const auto sections = map_file::read_saved_map(saved_map, {map_file::kMapper});
  if (!sections) return tl::unexpected(sections.error());
  const auto started = mapper_.start_from(sections->at(map_file::kMapper));
  return started ? started : refuse(started.error());
}

service::CommandOutcome MapperService::save(const std::string& folder) const {
  const std::filesystem::path place(folder);
  for (const WriteResult& result :
       {write_tree(place / "map.ot", mapper_.tree()),
        write_objects(place / "objects.json", mapper_.objects()), write_grid(place, mapper_.grid()),
        map_file::write_map_file(map_file::service_file(place, map_file::kMapper),
                                 {{map_file::kMapper, mapper_.to_bytes()}})})
    if (!result) return {false, result.error()};
  return {true, fmt::format("map of {} nodes written to {}", mapper_.tree().size(), folder)};
}

service::CommandOutcome MapperService::load(const std::string& saved_map) {
  if (const auto started = start_from(saved_map); !started) return {false, started.error()};
  waiting_.clear();
  integrated_by_stamp_.clear();
  outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
  return {true, fmt::format("map of {} nodes", mapper_.tree().size())};
}

}  // namespace rds::mapper
