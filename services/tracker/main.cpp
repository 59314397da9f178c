// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::tracker;
  return rds::service::run_service<TrackerService, TrackerServiceConfig>("rds-tracker", argc, argv);
}
