// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace rds::map_file {
namespace {

constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
constexpr mode_t kFileMode = S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH;

}  // namespace

std::string Folder::sentence(const std::string& name, const std::string& fault) const {
  return fmt::format("{}: {}", (path_ / name).string(), fault);
}

tl::expected<Folder, std::string> Folder::open(const std::filesystem::path& path) {
  Descriptor descriptor(::open(path.c_str(), kFolder));
  if (!descriptor.is_open())
    return tl::unexpected(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  return Folder(std::move(descriptor), path);
}

tl::expected<Folder, std::string> Folder::enter(const std::string& name) const {
  Descriptor descriptor(openat(number(), name.c_str(), kFolder | O_NOFOLLOW));
  if (!descriptor.is_open())
    return tl::unexpected(sentence(name, fmt::format("cannot be opened: {}", std::strerror(errno))));
  return Folder(std::move(descriptor), path_ / name);
}

tl::expected<Folder, std::string> Folder::make(const std::string& name) const {
  if (mkdirat(number(), name.c_str(), S_IRWXU) != 0 && errno != EEXIST)
    return tl::unexpected(sentence(name, fmt::format("cannot be made: {}", std::strerror(errno))));
  return enter(name);
}

bool Folder::has_file(const std::string& name) const {
  struct stat about {};
  return fstatat(number(), name.c_str(), &about, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(about.st_mode);
}

std::vector<std::string> Folder::names() const {
  const std::unique_ptr<DIR, int (*)(DIR*)> list(fdopendir(openat(number(), ".", kFolder)), closedir);
  std::vector<std::string> names;
  if (!list) return names;
  while (const dirent* entry = readdir(list.get()))
    if (const std::string name = entry->d_name; name != "." && name != "..") names.push_back(name);
  std::ranges::sort(names);
  return names;
}

tl::expected<std::vector<std::uint8_t>, std::string> Folder::read(const std::string& name,
                                                                  const FileLimits& limits) const {
  const Descriptor file(
      openat(number(), name.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW | O_CLOEXEC));
  auto bytes = read_all(file, limits);
  if (!bytes) return tl::unexpected(sentence(name, "cannot be read: " + bytes.error()));
  return bytes;
}

tl::expected<void, std::string> Folder::write(const std::string& name, std::span<const std::uint8_t> bytes,
                                              const FileLimits& limits) const {
  const std::string partial = name + ".partial";
  const auto refuse = [&](const std::string& fault) {
    return tl::unexpected(sentence(name, "cannot be written: " + fault));
  };
  const Descriptor file(openat(number(), partial.c_str(),
                               O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kFileMode));
  if (!file.is_open()) return refuse(std::strerror(errno));
  const auto written = write_durably(file, bytes, limits);
  const bool named =
      written && renameat2(number(), partial.c_str(), number(), name.c_str(), RENAME_NOREPLACE) == 0;
  if (named) return {};
  const std::string fault = written ? std::strerror(errno) : written.error();
  remove(partial);
  return refuse(fault);
}

void Folder::remove(const std::string& name) const {
  if (unlinkat(number(), name.c_str(), 0) == 0 || (errno != EISDIR && errno != EPERM)) return;
  if (const auto folder = enter(name))
    for (const std::string& inside : folder->names()) folder->remove(inside);
  (void)unlinkat(number(), name.c_str(), AT_REMOVEDIR);
}

void Folder::sync() const {
  (void)fsync(number());
}

}  // namespace rds::map_file
