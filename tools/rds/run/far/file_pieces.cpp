// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/file_pieces.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <openssl/evp.h>

namespace rds::run {
namespace fs = std::filesystem;
namespace {

bool is_below(const fs::path& path) {
  return !path.empty() && path.is_relative() && std::ranges::find(path, "..") == path.end();
}

const unsigned char* octets(const std::string& text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

std::string to_base64(const std::string& bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  text.resize(static_cast<std::size_t>(EVP_EncodeBlock(
      reinterpret_cast<unsigned char*>(text.data()), octets(bytes), static_cast<int>(bytes.size()))));
  return text;
}

}  // namespace

std::string list_files(const fs::path& folder, const std::string& prefix) {
  nlohmann::json list = nlohmann::json::array();
  if (!is_below(prefix) || !fs::is_directory(folder / prefix)) return list.dump();
  for (const auto& entry : fs::recursive_directory_iterator(folder / prefix))
    if (entry.is_regular_file() && !entry.is_symlink())
      list.push_back({fs::relative(entry.path(), folder).string(), entry.file_size()});
  return list.dump();
}

std::vector<FileEntry> parse_files(const std::string& text) {
  std::vector<FileEntry> files;
  try {
    for (const auto& entry : nlohmann::json::parse(text))
      files.push_back({entry.at(0).get<std::string>(), entry.at(1).get<std::uint64_t>()});
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("not a list of files");
  }
  for (const FileEntry& file : files)
    if (!is_below(file.path)) throw std::runtime_error(file.path + ": not below the folder of a run");
  return files;
}

std::string piece_request(const FileEntry& file, std::uint64_t offset) {
  return fmt::format("{} {}", offset, file.path);
}

std::string read_piece(const fs::path& folder, const std::string& request) {
  std::uint64_t offset = 0;
  const auto space = std::min(request.find(' '), request.size());
  const auto number = std::from_chars(request.data(), request.data() + space, offset);
  const std::string path = request.substr(std::min(space + 1, request.size()));
  std::string bytes(kPieceBytes, '\0');
  std::ifstream file;
  if (number.ec == std::errc() && number.ptr == request.data() + space && is_below(path))
    file.open(folder / path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(offset));
  if (!file) throw std::runtime_error(request + ": cannot be read");
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return to_base64(bytes);
}

std::string parse_piece(const std::string& base64, std::size_t bytes) {
  std::string piece(base64.size() / 4 * 3 + 3, '\0');
  const int decoded = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(piece.data()), octets(base64),
                                      static_cast<int>(base64.size()));
  // The text is filled up to whole groups of three bytes.
  const auto filled = static_cast<std::size_t>(std::max(decoded, 0));
  if (filled != (bytes + 2) / 3 * 3) throw std::runtime_error("a piece of a file has another size");
  piece.resize(bytes);
  return piece;
}

}  // namespace rds::run
