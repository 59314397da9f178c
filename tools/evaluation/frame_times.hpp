// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

namespace rds::evaluation {

/// Reads columns of numbers from frames.csv (first line: column names).
///
/// @return column name to its values, or one sentence that names file, line and expectation.
tl::expected<std::map<std::string, std::vector<double>>, std::string> read_csv_columns(
    const std::filesystem::path& file, const std::vector<std::string>& columns);

}  // namespace rds::evaluation
