// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/joint_save.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "common/map_file/named_map.hpp"
#include "common/map_file/replace_folder.hpp"

namespace rds::map_file {
namespace {

using Sentence = std::string;

const std::string kSaving = ".saving";
const std::string kOrder = "save";  // section of a part, as long as it waits: the order it is of
constexpr std::time_t kLeftOverS = 600;
constexpr std::size_t kMaxWaitingSaves = 7;  // besides the one that begins

std::string file_of(const std::string& part) {
  return part + ".rds";
}

Bytes bytes_of(const SaveOrder& order) {
  const std::string text = fmt::format("{} {} {}", order.name, order.id, fmt::join(order.parts, ","));
  return {text.begin(), text.end()};
}

/// Saves that nobody completes, and the oldest where too many wait. A save from the future is one of before the
/// clock was set back.
void remove_left_over(const Folder& saving) {
  std::multimap<std::time_t, std::string> waiting;
  for (const std::string& name : saving.names()) {
    struct stat about {};
    if (fstatat(saving.number(), name.c_str(), &about, AT_SYMLINK_NOFOLLOW) == 0)
      waiting.emplace(about.st_mtim.tv_sec, name);
  }
  std::size_t left = waiting.size();
  for (const auto& [changed_s, name] : waiting) {
    if (left <= kMaxWaitingSaves && std::abs(std::time(nullptr) - changed_s) <= kLeftOverS) continue;
    saving.remove(name);
    --left;
  }
}

tl::expected<void, Sentence> write_part(const Folder& place, const SaveOrder& order, MapPart part,
                                        const FileLimits& limits) {
  for (const auto& [name, bytes] : part.files)
    if (auto written = place.write(name, bytes, limits); !written) return written;
  part.sections[kOrder] = bytes_of(order);
  return place.write(file_of(part.name), to_bytes(part.sections), limits);  // last: now it is there
}

/// All parts in one map.rds, in place of theirs.
tl::expected<void, Sentence> merge(const Folder& place, const SaveOrder& order, const FileLimits& limits) {
  Sections all;
  for (const std::string& part : order.parts) {
    const auto bytes = place.read(file_of(part), limits);
    if (!bytes) return tl::unexpected(bytes.error());
    auto sections = sections_from_bytes(*bytes);
    const auto refuse = [&](const std::string& why) {
      return tl::unexpected(fmt::format("{}: {}", (place.path() / file_of(part)).string(), why));
    };
    if (!sections) return refuse(sections.error());
    const auto own = sections->extract(kOrder);
    if (!own || own.mapped() != bytes_of(order)) return refuse("is a part of another save");
    all.merge(*sections);
    if (!sections->empty()) return refuse("has a section that another part has, too");
  }
  if (auto written = place.write(kMapFile, to_bytes(all), limits); !written) return written;
  for (const std::string& part : order.parts) place.remove(file_of(part));
  place.sync();
  return {};
}

/// What has the name already must be a map.
tl::expected<void, Sentence> publish(const Folder& maps, const Folder& saving, const std::string& finished,
                                     const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: {}", (maps.path() / name).string(), why));
  };
  struct stat about {};
  if (fstatat(maps.number(), name.c_str(), &about, AT_SYMLINK_NOFOLLOW) == 0) {
    const auto old = maps.enter(name);
    if (!old || (!old->has_file(kMapFile) && !old->names().empty()))
      return refuse("holds what is no map, and is not replaced");
  }
  const auto replaced = replace_folder(saving.number(), finished, maps.number(), name);
  if (!replaced) return refuse("cannot be written: " + replaced.error());
  maps.sync();
  if (*replaced) saving.remove(finished);
  return {};
}

/// Claims the folder by its new name: of services whose parts come at the same time one succeeds.
tl::expected<SaveState, Sentence> complete(const Folder& maps, const Folder& saving, const Folder& place,
                                           const SaveOrder& order, const FileLimits& limits) {
  const std::string waiting = order.name + "." + order.id;
  const std::string claimed = "." + waiting;  // the name of no other save
  if (renameat2(saving.number(), waiting.c_str(), saving.number(), claimed.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == ENOENT) return SaveState::kComplete;
    return tl::unexpected(fmt::format("{}: {}", (saving.path() / claimed).string(), std::strerror(errno)));
  }
  auto done = merge(place, order, limits);
  if (done) done = publish(maps, saving, claimed, order.name);
  if (done) return SaveState::kPublished;
  saving.remove(claimed);
  return tl::unexpected(done.error());
}

}  // namespace

tl::expected<void, std::string> check(const SaveOrder& order) {
  if (auto name = check_map_name(order.name); !name) return name;
  if (!check_map_name(order.id) || order.id.find('.') != std::string::npos)
    return tl::unexpected<std::string>("not the id of a save, expected 1 to 64 of A-Z a-z 0-9 _ -");
  const std::set<std::string> different(order.parts.begin(), order.parts.end());
  const bool known = std::ranges::all_of(
      order.parts, [](const std::string& part) { return std::ranges::count(kParts, part) > 0; });
  if (order.parts.empty() || different.size() < order.parts.size() || !known)
    return tl::unexpected(fmt::format("not the parts of a map, expected some of {}", fmt::join(kParts, ", ")));
  return {};
}

tl::expected<SaveState, std::string> save_part(const std::filesystem::path& maps, const SaveOrder& order,
                                               MapPart part, const FileLimits& limits) {
  if (const auto checked = check(order); !checked) return tl::unexpected(checked.error());
  const auto folder = Folder::open(maps);
  if (!folder) return tl::unexpected(folder.error());
  const auto saving = folder->make(kSaving);
  if (!saving) return tl::unexpected(saving.error());
  remove_left_over(*saving);
  const std::string waiting = order.name + "." + order.id;
  const auto place = saving->make(waiting);
  if (!place) return tl::unexpected(place.error());
  if (place->has_file(file_of(part.name)))
    return tl::unexpected(fmt::format("{}: is there already", (place->path() / file_of(part.name)).string()));
  if (const auto written = write_part(*place, order, std::move(part), limits); !written) {
    saving->remove(waiting);
    return tl::unexpected(written.error());
  }
  const auto is_there = [&](const std::string& other) { return place->has_file(file_of(other)); };
  if (!std::ranges::all_of(order.parts, is_there)) return SaveState::kWaits;
  return complete(*folder, *saving, *place, order, limits);
}

}  // namespace rds::map_file
