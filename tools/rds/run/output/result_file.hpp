// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::run {

/// Writes a file of a run's results: when it returns, the disk has all of it.
/// @throws std::runtime_error with one sentence that names the file.
void write_result(const std::filesystem::path& file, const std::string& content);

/// The same for a picture, encoded as its ending says. @param parameters  as cv::imencode takes them.
void write_picture(const std::filesystem::path& file, const cv::Mat& picture,
                   const std::vector<int>& parameters = {});

}  // namespace rds::run
