// SPDX-License-Identifier: Apache-2.0
#include "common/service/run_service.hpp"
#include "services/mapper/mapper_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::mapper;
  return rds::service::run_service<MapperService, MapperServiceConfig>("rds-mapper", argc, argv,
                                                                       rds::service::kShippedSettings);
}
