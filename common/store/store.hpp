// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "common/store/batch.hpp"
#include "common/store/sqlite.hpp"

namespace rds::store {

inline constexpr std::uint32_t kStoreVersion = 1;

/// Why a store cannot be opened.
struct Fault {
  enum class Kind {
    kForeign,      // not a store of ours, or no regular file
    kNewer,        // of a later version of this program
    kDamaged,      // rows are missing or other than they were written
    kUnavailable,  // no such folder, not allowed, in use, no room
  };
  Kind kind = Kind::kUnavailable;
  std::string sentence;  // names the file
};

/// Rows of bytes by kind and id in one SQLite file.
///
/// Changes are made in batches, each as a whole: a process that is killed, or a disk that is full, leaves the
/// rows before or after a batch. Every row has a checksum, and all of them together a manifest, which open()
/// compares. Not thread-safe.
class Store {
 public:
  /// Opens a file and looks at every row; makes it if it is not there. Its folder must exist.
  /// @param max_bytes  that the file may have; 0: no limit. Beyond it apply() fails as on a full disk.
  static tl::expected<Store, Fault> open(const std::filesystem::path& file, std::uint64_t max_bytes = 0);
  /// A file without a name, that goes with the process. @param folder  empty: the system's for temporary
  /// files.
  static tl::expected<Store, Fault> nameless(const std::filesystem::path& folder);

  /// @return or one sentence: then nothing has changed. Rows that are as they were are not written again.
  tl::expected<void, std::string> apply(const Batch& batch);
  /// The bytes of a row, nullopt if it is not there; or one sentence: it cannot be read, or is not as it was
  /// written.
  [[nodiscard]] tl::expected<std::optional<Bytes>, std::string> get(std::string_view kind,
                                                                    std::uint64_t id) const;
  using Visit = std::function<void(std::uint64_t id, std::span<const std::uint8_t> bytes)>;
  /// Visits the rows of a kind by ascending id. @return or one sentence, as get().
  [[nodiscard]] tl::expected<void, std::string> for_each(std::string_view kind, const Visit& visit) const;

  /// Replaces `file` by a copy of this store, at once or not at all; flushed to the disk.
  /// @param go_on  asked now and then; false: the copy is given up.
  [[nodiscard]] tl::expected<void, std::string> copy_to(
      const std::filesystem::path& file, const std::function<bool()>& go_on = [] { return true; }) const;

  [[nodiscard]] std::uint64_t rows() const { return manifest_.rows; }

 private:
  struct Manifest {
    std::uint64_t rows = 0;
    std::uint64_t digest = 0;  // sum of the rows' checksums
  };
  using Result = SqliteResult<void>;

  Store(Connection connection, std::filesystem::path file)
      : connection_(std::move(connection)), file_(std::move(file)) {}
  [[nodiscard]] std::string say(const std::string& what) const;
  [[nodiscard]] Result set_up(std::uint64_t max_bytes) const;
  [[nodiscard]] Result make_tables() const;
  [[nodiscard]] std::optional<Fault> identify() const;
  [[nodiscard]] std::optional<std::string> verify();
  Result change(const Batch& batch);
  Result write_manifest(const Manifest& manifest) const;

  Connection connection_;
  std::filesystem::path file_;
  Manifest manifest_;
};

}  // namespace rds::store
