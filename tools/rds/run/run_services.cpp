// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/run_services.hpp"

#include "tools/rds/cli/wait.hpp"
#include "tools/rds/run/services/service_commands.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::run {
namespace {

constexpr std::chrono::seconds kStopLimit{30};  // on a busy disk a file of a floor takes a while to go

}  // namespace

RunServices::RunServices(const RunOptions& options, int domain, const std::filesystem::path& folder,
                         bus::Participant& bus, const std::optional<Elsewhere>& elsewhere)
    : folder_(folder),
      far_(elsewhere ? std::make_unique<FarMachines>(bus, options, elsewhere->hosts, elsewhere->here)
                     : nullptr),
      fleet_(service_commands(options, domain, folder)),
      keeps_viewer_(options.view_keep) {
  if (!options.view.empty())
    viewer_ = std::make_unique<Fleet>(std::vector<ServiceCommand>{viewer_command(options, domain, folder)});
}

void RunServices::begin_elsewhere(const std::stop_token& stop) {
  if (far_) far_->begin(stop);
}

void RunServices::watch() {
  fleet_.watch();
  if (viewer_) viewer_->watch();
  if (far_) far_->watch();
}

std::set<std::string> RunServices::names() const {
  std::set<std::string> all = fleet_.names();
  if (viewer_) all.merge(viewer_->names());
  all.merge(elsewhere());
  return all;
}

std::set<std::string> RunServices::elsewhere() const {
  return far_ ? far_->services() : std::set<std::string>{};
}

bool RunServices::alive(const std::string& name) {
  return fleet_.alive(name) || (far_ && far_->alive(name));
}

void RunServices::fetch(const std::string& folder, const std::stop_token& stop) {
  if (far_) far_->fetch(folder, folder_, stop);
}

std::map<std::string, ServiceUsage> RunServices::stop(const std::stop_token& stop) {
  fleet_.stop(kStopLimit);
  if (viewer_ && !keeps_viewer_) viewer_->stop(kStopLimit);
  auto usage = fleet_.usage();
  if (!far_ || stop.stop_requested()) return usage;
  usage.merge(far_->stop_services(stop));
  for (const char* folder : {"log", "config"}) fetch(folder, stop);
  far_->leave(stop);
  return usage;
}

void RunServices::keep_viewer(const std::stop_token& stop) {
  constexpr std::chrono::hours kLongest{24 * 365};
  tools::wait_until(std::chrono::steady_clock::now() + kLongest, stop, [&] {
    if (!stop.stop_requested()) viewer_->watch();
    return !viewer_->alive(kViewer);
  });
  viewer_->stop(kStopLimit);
}

}  // namespace rds::run
