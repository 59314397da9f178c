// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/doctor_command.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/rds/doctor/dataset_check.hpp"
#include "tools/rds/doctor/host_check.hpp"
#include "tools/rds/exit.hpp"

namespace rds::doctor {
namespace {

struct DoctorOptions {
  std::string dataset;
  std::size_t every = 1;
};

void conclude(const std::vector<Finding>& findings) {
  fmt::print("{}", to_text(findings));
  if (any_fault(findings)) throw CLI::RuntimeError(tools::kExitFault);
}

std::vector<Finding> check_recording(const DoctorOptions& options) {
  return check_dataset(tools::value_or_exit(image::TumDataset::open(options.dataset)), options.every);
}

}  // namespace

void add_doctor_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("doctor", "Check this machine, or a recording");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("--dataset", options->dataset, "Folder of a recording to check");
  command->add_option("--every", options->every, "Look at every n-th frame's pictures only")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->callback(
      [options] { conclude(options->dataset.empty() ? check_host() : check_recording(*options)); });
}

}  // namespace rds::doctor
