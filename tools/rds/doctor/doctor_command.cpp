// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/cli/recording_option.hpp"
#include "tools/rds/doctor/checks/dataset_check.hpp"
#include "tools/rds/doctor/host_check.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::doctor {
namespace {

constexpr std::size_t kMostFrames = 1500;  // a quarter of a minute

struct DoctorOptions {
  std::filesystem::path dataset;
  std::size_t every = 0;  // 0: such that at most kMostFrames are looked at
};

void conclude(const std::vector<Finding>& findings) {
  fmt::print("{}", to_text(findings));
  if (any_fault(findings)) throw CLI::RuntimeError(tools::kExitFault);
}

std::vector<Finding> check_recording(const DoctorOptions& options) {
  const auto opened = tools::value_or_exit(recording::open_recording(options.dataset));
  fmt::print(stderr, "{}", opened.notes);
  const image::Recording& dataset = *opened.recording;
  const std::size_t needed = (dataset.frames().size() + kMostFrames - 1) / kMostFrames;
  return check_dataset(dataset, options.every > 0 ? options.every : needed);
}

}  // namespace

void add_doctor_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("doctor", "Check this machine, or a recording");
  const auto options = std::make_shared<DoctorOptions>();
  add_recording_option(*command, options->dataset);
  command
      ->add_option("--every", options->every,
                   "Look at every n-th frame's pictures only (default: all, of long ones up to 1500 evenly)")
      ->check(CLI::Range(1, 1000));
  command->callback(
      [options] { conclude(options->dataset.empty() ? check_host() : check_recording(*options)); });
}

}  // namespace rds::doctor
