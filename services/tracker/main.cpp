// SPDX-License-Identifier: Apache-2.0
#include <opencv2/core.hpp>

#include "common/service/run_service.hpp"
#include "services/tracker/tracker_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::tracker;
  cv::setNumThreads(1);  // the worker has a helper of its own; OpenCV's pool would only contend with it
  return rds::service::run_service<TrackerService, TrackerServiceConfig>("rds-tracker", argc, argv,
                                                                         rds::service::kShippedSettings);
}
