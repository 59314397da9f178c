// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

namespace rds::bus {

// The folder of a secured domain, made by `rds secure init`: kCaFile and kGovernanceFile, and one folder per
// identity with the other three. A machine needs the first two and the folders of what runs on it.
inline constexpr const char* kCaFile = "ca.pem";
inline constexpr const char* kGovernanceFile = "governance.p7s";
inline constexpr const char* kCertificateFile = "cert.pem";
inline constexpr const char* kKeyFile = "key.pem";
inline constexpr const char* kPermissionsFile = "permissions.p7s";

inline constexpr int kHighestSecuredDomain = 230;  // Cyclone DDS accepts no documents for the two above

/// The files by which a participant proves who it is, and what it and the others may do. Absolute paths.
struct Credentials {
  std::string identity;
  std::filesystem::path ca;
  std::filesystem::path governance;
  std::filesystem::path certificate;
  std::filesystem::path key;
  std::filesystem::path permissions;
};

/// The credentials of `identity` in the folder of a secured domain. They belong together: one authority has
/// signed certificate, governance and permissions; key and permissions are of the certificate, which is of
/// `identity` and valid at `now`.
///
/// @return or one sentence that names the file and what was expected: the vendors say less.
tl::expected<Credentials, std::string> read_credentials(
    const std::filesystem::path& folder, const std::string& identity,
    std::chrono::system_clock::time_point now = std::chrono::system_clock::now());

}  // namespace rds::bus
