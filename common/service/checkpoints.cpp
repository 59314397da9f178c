// SPDX-License-Identifier: Apache-2.0
#include "common/service/checkpoints.hpp"

#include <spdlog/spdlog.h>

namespace rds::service {
namespace {

void report(const std::string& failure) {
  if (failure.empty())
    spdlog::info("the map is kept on the disk again");
  else
    spdlog::warn("the map cannot be kept on the disk, is tried again: {}", failure);
}

tl::expected<store::Checkpoint, std::string> open(const store::MapsConfig& config,
                                                  const ServiceContext& context, const std::string& service) {
  const auto maps = store::maps_folder(config);
  if (!maps) return tl::unexpected(maps.error());
  return store::open_checkpoint(
      store::checkpoint_file(*maps, context.domain, context.node_namespace, service));
}

}  // namespace

std::unique_ptr<store::CheckpointWriter> open_checkpoints(ServiceContext& context,
                                                          const store::MapsConfig& config,
                                                          const std::string& service) {
  if (!config.checkpoint) return nullptr;
  auto checkpoint = open(config, context, service);
  if (!checkpoint) {
    ++context.diagnostics.counter("checkpoints failed");
    spdlog::warn("goes on without checkpoints: {}", checkpoint.error());
    return nullptr;
  }
  for (const std::string& what : checkpoint->found) spdlog::warn("{}", what);
  spdlog::info("checkpoint {} of {} rows", checkpoint->file.string(), checkpoint->store.rows());
  const auto backup = std::chrono::duration<double>(config.backup_s);
  store::CheckpointWriter::Limits limits;
  limits.backup = std::chrono::duration_cast<std::chrono::milliseconds>(backup);
  auto writer = std::make_unique<store::CheckpointWriter>(std::move(*checkpoint), limits, report);
  context.diagnostics.gauge("checkpoints written",
                            [writer = writer.get()] { return writer->log().written(); });
  context.diagnostics.gauge("checkpoint writes failed",
                            [writer = writer.get()] { return writer->log().failed(); });
  return writer;
}

}  // namespace rds::service
