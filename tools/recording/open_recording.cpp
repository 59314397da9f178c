// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/open_recording.hpp"

#include <fmt/format.h>

#include "common/image/tum_dataset.hpp"
#include "tools/recording/bag_recording.hpp"
#include "tools/recording/benchmarks/benchmarks.hpp"

namespace rds::recording {
namespace fs = std::filesystem;
namespace {

using Opened = tl::expected<OpenedRecording, std::string>;

}  // namespace

Opened open_recording(const fs::path& path) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  if (is_bag(path)) {
    auto bag = BagRecording::open(path);
    if (!bag) return tl::unexpected(bag.error());
    std::string notes = (*bag)->notes();
    return OpenedRecording{std::move(*bag), std::move(notes)};
  }
  if (!is_folder && fs::exists(path, error))
    return tl::unexpected(fmt::format(
        "{}: expected a recording: a folder, or a file that ends in .mcap or .db3", path.string()));
  if (is_folder && !fs::exists(path / "rgb.txt", error)) {
    if (auto benchmark = open_benchmark(path)) {
      if (!*benchmark) return tl::unexpected(benchmark->error());
      return OpenedRecording{std::move(**benchmark), ""};
    }
  }
  auto dataset = image::TumDataset::open(path);
  if (!dataset) return tl::unexpected(dataset.error());
  return OpenedRecording{std::make_unique<image::TumDataset>(std::move(*dataset)), ""};
}

}  // namespace rds::recording
