// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/rate_option.hpp"

#include <cmath>

#include <CLI/CLI.hpp>

namespace rds {

void add_rate_option(CLI::App& command, double& rate) {
  command
      .add_option_function<std::string>(
          "--rate",
          [&rate](const std::string& text) {
            if (text == "max") {
              rate = 0;
              return;
            }
            if (!CLI::detail::lexical_cast(text, rate) || !(rate > 0) || !std::isfinite(rate))
              throw CLI::ValidationError("--rate", text + ": expected a positive number or max");
          },
          "times the recorded speed, or max: as fast as the tracker acknowledges, reproducible")
      ->default_str("1.0");
}

}  // namespace rds
