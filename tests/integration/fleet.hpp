// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/run_support.hpp"

namespace rds::test {

/// The five services as processes of one domain, with a folder of maps that outlasts them.
class Fleet {
 public:
  static constexpr auto kServices = {"rds-tracker", "rds-detector", "rds-transformer", "rds-mapper",
                                     "rds-loop-closer"};

  Fleet(int domain, std::string vendor) : domain_(domain), vendor_(std::move(vendor)) { start(); }

  void start() {
    for (const char* service : kServices)
      services_.push_back(std::make_unique<Process>(command(std::string(RDS_BIN_DIR) + "/" + service, {}),
                                                    Process::Environment{{"RDS_MAPS_DIR", maps().string()}}));
  }
  /// @return whether all were there to be killed.
  bool kill() {
    const bool all = all_run();
    for (const auto& service : services_) service->kill();
    for (const auto& service : services_) service->wait(std::chrono::seconds(10));
    last_log_ = log();
    services_.clear();
    return all;
  }
  [[nodiscard]] bool all_run() const {
    return std::ranges::all_of(services_, [](const auto& service) { return service->running(); });
  }
  /// In the order of kServices.
  [[nodiscard]] const std::vector<std::unique_ptr<Process>>& services() const { return services_; }
  [[nodiscard]] std::filesystem::path maps() const { return maps_.path(); }

  /// A command that plays a recording to them, over and over, time going on.
  [[nodiscard]] std::vector<std::string> player(const std::filesystem::path& recording,
                                                const std::string& rate) const {
    return command(rds(), {"play", recording.string(), "--loop", "--rate", rate});
  }

  [[nodiscard]] std::string log() const {
    std::string all;
    for (const auto& service : services_) all += service->standard_error() + service->standard_output();
    return all;
  }
  /// Of those that were killed last.
  [[nodiscard]] const std::string& last_log() const { return last_log_; }

 private:
  [[nodiscard]] std::vector<std::string> command(const std::string& program,
                                                 const std::vector<std::string>& arguments) const {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.insert(words.end(), {"--domain", std::to_string(domain_), "--loopback", "--bus", vendor_});
    return words;
  }

  int domain_;
  std::string vendor_;
  TemporaryFolder maps_;
  std::vector<std::unique_ptr<Process>> services_;
  std::string last_log_;
};

}  // namespace rds::test
