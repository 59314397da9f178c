// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/regular_file.hpp"

namespace rds::map_file {

/// A folder that is held open. What lies in it is reached through it, so that nobody can put a link, pipe or
/// device in the way; it may be renamed meanwhile. Names are single ones, without a slash.
///
/// Errors are one sentence that names the file.
class Folder {
 public:
  /// A folder that the user named; links are followed.
  static tl::expected<Folder, std::string> open(const std::filesystem::path& path);

  /// A folder in it.
  [[nodiscard]] tl::expected<Folder, std::string> enter(const std::string& name) const;
  /// The same, made with mode 0700 if it is not there.
  [[nodiscard]] tl::expected<Folder, std::string> make(const std::string& name) const;
  /// Whether there is a regular file of this name.
  [[nodiscard]] bool has_file(const std::string& name) const;
  /// Names of all that lies in it, sorted; empty where it cannot be read.
  [[nodiscard]] std::vector<std::string> names() const;

  [[nodiscard]] tl::expected<std::vector<std::uint8_t>, std::string> read(const std::string& name,
                                                                          const FileLimits& limits) const;
  /// Writes a file that must not be there; it has its name once the disk has all of it.
  [[nodiscard]] tl::expected<void, std::string> write(const std::string& name,
                                                      std::span<const std::uint8_t> bytes,
                                                      const FileLimits& limits) const;
  /// Removes a file, or a folder with all that is in it; that it is not there is no error.
  void remove(const std::string& name) const;
  /// Waits until the disk has the names of what lies in it.
  void sync() const;

  [[nodiscard]] int number() const { return descriptor_.number(); }
  /// As it was called when it was opened.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  Folder(Descriptor descriptor, std::filesystem::path path)
      : descriptor_(std::move(descriptor)), path_(std::move(path)) {}
  [[nodiscard]] std::string sentence(const std::string& name, const std::string& fault) const;

  Descriptor descriptor_;
  std::filesystem::path path_;
};

}  // namespace rds::map_file
