// SPDX-License-Identifier: Apache-2.0
#include "common/service/run_service.hpp"
#include "services/transformer/transformer_service.hpp"

int main(int argc, char** argv) {
  using namespace rds::transformer;
  return rds::service::run_service<TransformerService, TransformerServiceConfig>(
      "rds-transformer", argc, argv, rds::service::kShippedSettings);
}
