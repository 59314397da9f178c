// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace rds::run {

/// Files of one machine, read by another over the bus: in pieces that fit into a datagram as text.
inline constexpr std::size_t kPieceBytes = 900;

struct FileEntry {
  std::string path;  // below the folder that is read
  std::uint64_t bytes = 0;

  bool operator==(const FileEntry&) const = default;
};

/// Regular files below folder/prefix, as JSON; none if that is not there.
std::string list_files(const std::filesystem::path& folder, const std::string& prefix);
/// @throws std::runtime_error if the text is no such list, or names what is not below a folder.
std::vector<FileEntry> parse_files(const std::string& text);

/// What asks for a piece: "OFFSET PATH".
std::string piece_request(const FileEntry& file, std::uint64_t offset);
/// The piece in base64. @throws std::runtime_error with one sentence if there is none.
std::string read_piece(const std::filesystem::path& folder, const std::string& request);
/// The bytes of a piece. @param bytes  that it should have. @throws std::runtime_error if it has not.
std::string parse_piece(const std::string& base64, std::size_t bytes);

}  // namespace rds::run
