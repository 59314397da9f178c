// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/secure_folder.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/bus/security.hpp"
#include "common/bus/zenoh/zenoh_access.hpp"
#include "tools/rds/secure/security_documents.hpp"

namespace rds::secure {
namespace fs = std::filesystem;
namespace {

constexpr mode_t kPrivate = 0600;
constexpr mode_t kPublic = 0644;

[[noreturn]] void fail(const fs::path& path) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

void make_folder(const fs::path& folder) {
  if (mkdir(folder.c_str(), 0700) != 0) fail(folder);
}

/// A new file that nobody could ever read with another mode.
void write_file(const fs::path& file, mode_t mode, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (descriptor < 0) fail(file);
  const bool written = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       fsync(descriptor) == 0;
  if (close(descriptor) != 0 || !written) fail(file);
}

/// @return the names of the parts.
std::vector<std::string> fill(const fs::path& folder, const FolderOptions& options) {
  const CertificateAuthority authority(options.validity);
  write_file(folder / bus::kCaFile, kPublic, authority.certificate());
  write_file(folder / bus::kGovernanceFile, kPublic, authority.sign(governance(options.topics.camera)));
  const std::vector<Role> all = roles(options.topics);
  write_file(folder / bus::kAccessFile, kPublic, authority.sign(access_list(all)));
  std::vector<std::string> names;
  for (const Role& role : all) {
    const Identity identity = authority.issue(role.name);
    const fs::path part = folder / role.name;
    make_folder(part);
    write_file(part / bus::kCertificateFile, kPublic, identity.certificate);
    write_file(part / bus::kKeyFile, kPrivate, identity.key);
    write_file(part / bus::kPermissionsFile, kPublic,
               authority.sign(permissions(role, identity.subject, options.validity)));
    names.push_back(role.name);
  }
  return names;
}

/// @return a sentence if the folder must stay as it is.
std::string reason_to_keep(const fs::path& folder, bool force) {
  if (!fs::exists(fs::symlink_status(folder))) return "";
  if (!force)
    return fmt::format("{}: exists; --force makes new certificates, and the old ones are void",
                       folder.string());
  if (!fs::is_regular_file(folder / bus::kGovernanceFile))
    return fmt::format("{}: is no folder of rds secure init, and is left alone", folder.string());
  return "";
}

void put_in_place(const fs::path& made, const fs::path& folder) {
  fs::path former = made;
  former += ".former";
  const bool replaces = fs::exists(folder);
  if (replaces) fs::rename(folder, former);
  fs::rename(made, folder);
  if (replaces) fs::remove_all(former);
}

}  // namespace

Validity ten_years(std::chrono::system_clock::time_point now) {
  return {now - std::chrono::days(1), now + std::chrono::years(10)};
}

tl::expected<std::vector<std::string>, std::string> make_secure_folder(const fs::path& folder,
                                                                       const FolderOptions& options) {
  const fs::path target = fs::absolute(folder / "").parent_path();  // without a slash at the end
  fs::path made = target;
  made += fmt::format(".partial-{}", getpid());
  try {
    if (const std::string reason = reason_to_keep(target, options.force); !reason.empty())
      return tl::unexpected(reason);
    make_folder(made);
    auto names = fill(made, options);
    put_in_place(made, target);
    return names;
  } catch (const std::exception& e) {
    std::error_code ignored;
    fs::remove_all(made, ignored);
    return tl::unexpected(std::string(e.what()));
  }
}

}  // namespace rds::secure
