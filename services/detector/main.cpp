// SPDX-License-Identifier: Apache-2.0
#include "common/service/run_service.hpp"
#include "services/detector/detector_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::detector;
  return rds::service::run_service<DetectorService, DetectorServiceConfig>("rds-detector", argc, argv,
                                                                           rds::service::kShippedSettings);
}
