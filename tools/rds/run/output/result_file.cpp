// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/output/result_file.hpp"

#include <cstdint>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "common/map_file/atomic_file.hpp"

namespace rds::run {
namespace {

void check(const tl::expected<void, std::string>& written) {
  if (!written) throw std::runtime_error(written.error());
}

}  // namespace

void write_result(const std::filesystem::path& file, const std::string& content) {
  check(map_file::write_atomically(file, content));
}

void write_picture(const std::filesystem::path& file, const cv::Mat& picture,
                   const std::vector<int>& parameters) {
  std::vector<std::uint8_t> content;
  cv::imencode(file.extension().string(), picture, content, parameters);
  check(map_file::write_atomically(file, content));
}

}  // namespace rds::run
