// SPDX-License-Identifier: Apache-2.0
// A service, rds-hanging, whose worker hangs some seconds after its start, for the tests of what notices
// that.
#include <unistd.h>

#include "common/service/run_service.hpp"

namespace rds::test {

struct HangingConfig {
  int nice = 0;
  double hang_after_s = 0;  // [s]
};

void read(config::ConfigReader& reader, HangingConfig& config) {
  reader.value("hang_after_s", config.hang_after_s, 0.0, 1e6, "s");
}

class HangingService : public service::Service {
 public:
  HangingService(service::ServiceContext& context, const HangingConfig& config)
      : Service(context), hang_after_(config.hang_after_s) {}

  void run(const std::stop_token& stop) override {
    const auto start = std::chrono::steady_clock::now();
    wait(stop, [&] { return std::chrono::steady_clock::now() - start >= hang_after_; });
    while (true) pause();
  }

 protected:
  service::CommandOutcome execute(const std::string& verb, const std::string& /*argument*/) override {
    return unknown_command(verb);
  }

 private:
  std::chrono::duration<double> hang_after_;
};

}  // namespace rds::test

int main(int argc, char** argv) {
  using namespace rds::test;
  return rds::service::run_service<HangingService, HangingConfig>("rds-hanging", argc, argv, "");
}
