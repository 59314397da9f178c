// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace rds::test {

/// A fresh folder that disappears with the object, whatever is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Writes a text file, parents included. @throws std::runtime_error if that fails.
void write_text(const std::filesystem::path& file, const std::string& text);
/// The whole file as bytes. @throws std::runtime_error if it cannot be read.
std::string read_text(const std::filesystem::path& file);

}  // namespace rds::test
