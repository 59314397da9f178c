// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/secure/secure_folder.hpp"

namespace rds::secure {
namespace {

struct InitOptions {
  std::string folder;
  FolderOptions options;
};

void init(const InitOptions& init) {
  FolderOptions options = init.options;
  options.validity = ten_years(std::chrono::system_clock::now());
  const auto parts = tools::value_or_exit(make_secure_folder(init.folder, options));
  fmt::print("{}: valid until {:%Y-%m-%d}, for {}\n", init.folder, fmt::gmtime(options.validity.until),
             fmt::join(parts, ", "));
}

}  // namespace

void add_secure_command(CLI::App& rds) {
  auto* secure = rds.add_subcommand("secure", "Certificates and permissions of a secured bus");
  secure->require_subcommand(1);
  auto* command = secure->add_subcommand("init", "Make a folder for --secure, with one part per service");
  const auto options = std::make_shared<InitOptions>();
  command->add_option("folder", options->folder, "The folder to make")->required();
  command
      ->add_option("--camera-topics", options->options.topics.camera,
                   "All topics of the camera, * for any text; as many as there are")
      ->capture_default_str();
  command
      ->add_option("--sensor-topics", options->options.topics.sensors,
                   "Topics of the robot's odometry, IMU and initial pose, as the tracker's inputs name them")
      ->capture_default_str();
  command->add_flag("--force", options->options.force, "Replace such a folder: its certificates are void");
  command->callback([options] { init(*options); });
}

}  // namespace rds::secure
