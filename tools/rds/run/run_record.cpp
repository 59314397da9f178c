// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/run_record.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "tools/rds/run/services/join_bus.hpp"

namespace rds::run {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kQueueBytes = std::size_t{256} << 20;  // of outputs: minutes

std::unique_ptr<recording::BagWriter> new_bag(const fs::path& file, bool force) {
  std::error_code error;
  if (fs::exists(file, error) && !force)
    throw std::runtime_error(fmt::format("{}: is there already; --force overwrites it", file.string()));
  auto bag = recording::make_bag_writer(file, mcap::Compression::kLz4);
  if (!bag) throw std::runtime_error(bag.error());
  return std::move(*bag);
}

/// Readers of each topic that a process publishes.
std::map<std::string, int> readers_of(const std::vector<Endpoint>& endpoints) {
  std::map<std::string, int> readers;
  for (const Endpoint& endpoint : endpoints)
    if (endpoint.publisher) readers[endpoint.topic] += endpoint.matched;
  return readers;
}

}  // namespace

RunRecord::RunRecord(const RunOptions& options, int domain, const fs::path& file)
    : file_(file),
      bag_(new_bag(file, options.force), kQueueBytes),
      subscriptions_(std::make_unique<record::TopicSubscriptions>(
          run_participant(options, domain, "rds_run_record"), choice_, bag_)) {}

bool RunRecord::is_heard(const Endpoints& before, const Endpoints& now) const {
  for (const auto& [process, endpoints] : before) {
    if (process == kPlayer) continue;
    const auto found = now.find(process);
    if (found == now.end()) return false;
    auto readers = readers_of(found->second);
    for (const auto& [topic, count] : readers_of(endpoints))
      if (choice_.contains(topic) && readers[topic] <= count) return false;
  }
  return true;
}

std::string RunRecord::finish() {
  const std::uint64_t lost = subscriptions_->lost();
  subscriptions_.reset();
  if (const auto finished = bag_.finish(); !finished) return finished.error();
  std::uint64_t dropped = 0;
  for (const auto& count : bag_.counts()) dropped += count.dropped;
  if (dropped == 0 && lost == 0) return {};
  return fmt::format("{}: {} messages dropped, {} lost by the bus", file_.string(), dropped, lost);
}

}  // namespace rds::run
