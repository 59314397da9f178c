// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor_command.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/rds/dataset_check.hpp"
#include "tools/rds/exit.hpp"
#include "tools/rds/host_check.hpp"

namespace rds::tools {
namespace {

struct DoctorOptions {
  std::string dataset;
  std::size_t every = 1;
};

void conclude(const std::vector<Finding>& findings) {
  fmt::print("{}", to_text(findings));
  if (any_fault(findings)) throw CLI::RuntimeError(kExitFault);
}

std::vector<Finding> check_dataset(const DoctorOptions& options) {
  const auto dataset = value_or_exit(image::TumDataset::open(options.dataset));
  auto findings = check_lists(dataset);
  const auto looks = look_at_pictures(dataset, options.every);
  for (auto& finding : check_looks(looks, dataset.depth_scale())) findings.push_back(std::move(finding));
  return findings;
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
      [options] { conclude(options->dataset.empty() ? check_host() : check_dataset(*options)); });
}

}  // namespace rds::tools
