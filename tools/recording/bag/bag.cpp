// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/bag.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "tools/recording/bag/db3_bag.hpp"
#include "tools/recording/bag/mcap_bag.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

const std::string kMetadata = "metadata.yaml";

using OpenedBag = tl::expected<std::unique_ptr<Bag>, std::string>;

/// Several files of one bag, one after the other.
class SplitBag final : public Bag {
 public:
  explicit SplitBag(std::vector<std::unique_ptr<Bag>> files) : files_(std::move(files)) {}

  tl::expected<BagScan, std::string> scan(const Visit& visit) override {
    BagScan all;
    for (std::size_t i = 0; i < files_.size(); ++i) {
      const auto scan =
          files_[i]->scan([&](const BagTopic& topic, const BagMessage& message, BagPlace place) {
            place.file = i;
            visit(topic, message, place);
          });
      if (!scan) return scan;
      all.messages += scan->messages;
      if (all.fault.empty()) all.fault = scan->fault;
    }
    return all;
  }
  [[nodiscard]] tl::expected<Bytes, std::string> data_at(const BagPlace& place) const override {
    return files_.at(place.file)->data_at(place);
  }

 private:
  std::vector<std::unique_ptr<Bag>> files_;
};

OpenedBag open_file(const fs::path& file) {
  if (file.extension() == ".mcap") return McapBag::open(file);
  if (file.extension() == ".db3") return Db3Bag::open(file);
  return tl::unexpected(fmt::format("{}: expected a recording that ends in .mcap or .db3", file.string()));
}

/// The names of a rosbag2 folder's files. @return or one sentence.
tl::expected<std::vector<std::string>, std::string> files_of(const fs::path& metadata) {
  try {
    const YAML::Node information = YAML::LoadFile(metadata.string())["rosbag2_bagfile_information"];
    if (const auto mode = information["compression_mode"]; mode) {
      const auto name = mode.as<std::string>();
      if (!name.empty() && name != "none" && name != "NONE" && name != "storage" && name != "STORAGE")
        return tl::unexpected(
            fmt::format("{}: compressed by {}, expected a bag without compression, or an MCAP file "
                        "with compressed chunks (ros2 bag convert makes them)",
                        metadata.string(), name));
    }
    return information["relative_file_paths"].as<std::vector<std::string>>();
  } catch (const YAML::Exception& e) {
    return tl::unexpected(
        fmt::format("{}: {}, expected rosbag2's description of a bag", metadata.string(), e.what()));
  }
}

OpenedBag open_folder(const fs::path& folder) {
  const auto names = files_of(folder / kMetadata);
  if (!names) return tl::unexpected(names.error());
  if (names->empty()) return tl::unexpected(fmt::format("{}: names no files", (folder / kMetadata).string()));
  std::vector<std::unique_ptr<Bag>> files;
  for (const std::string& name : *names) {
    auto file = open_file(folder / fs::path(name).filename());  // whatever else it says: in this folder
    if (!file) return file;
    files.push_back(std::move(*file));
  }
  return std::make_unique<SplitBag>(std::move(files));
}

}  // namespace

bool is_bag(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return fs::exists(path / kMetadata, error);
  return path.extension() == ".mcap" || path.extension() == ".db3";
}

OpenedBag open_bag(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? open_folder(path) : open_file(path);
}

}  // namespace rds::recording
