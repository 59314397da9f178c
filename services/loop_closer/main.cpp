// SPDX-License-Identifier: Apache-2.0
#include "common/service/run_service.hpp"
#include "services/loop_closer/loop_closer_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::loop_closer;
  return rds::service::run_service<LoopCloserService, LoopCloserServiceConfig>(
      "rds-loop-closer", argc, argv, rds::service::kShippedSettings);
}
