// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/map_commands.hpp"

#include <exception>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "common/map_commands/save_command.hpp"
#include "common/map_file/named_map.hpp"

namespace rds::map_commands {
namespace fs = std::filesystem;
namespace {

/// An answer that needs nothing of the worker.
MapCommands::Completion answer(bool success, const std::string& message) {
  return [outcome = service::CommandOutcome{success, message}] { return outcome; };
}

tl::expected<fs::path, std::string> make_maps_folder(const store::MapsConfig& config) {
  const auto maps = store::maps_folder(config);
  if (!maps) return maps;
  if (const auto made = store::make_private_folder(*maps); !made) return tl::unexpected(made.error());
  return maps;
}

}  // namespace

MapCommands::MapCommands(concurrency::Mailbox& worker, const store::MapsConfig& config, std::string own_part,
                         std::chrono::milliseconds limit)
    : config_(config),
      own_part_(std::move(own_part)),
      limit_(limit),
      done_(worker, 1),
      orders_(mailbox_, 1),
      thread_([this](const std::stop_token& stop) {
        while (mailbox_.wait(stop, [this] { return !orders_.locked_empty(); }))
          if (const auto order = orders_.try_pop()) done_.push({order->number, carry_out(*order, stop)});
      }) {}

MapCommands::~MapCommands() {
  thread_.request_stop();
  thread_.join();
  if (under_way_) under_way_->answer({false, "the service has stopped"});
}

MapCommands::Completion MapCommands::carry_out(const Order& order, const std::stop_token& stop) const {
  map_file::FileLimits limits = limits_of(config_);
  limits.deadline = order.deadline;
  limits.stop = stop;
  try {
    return order.job(limits);
  } catch (const std::exception& e) {
    return answer(false, e.what());
  }
}

void MapCommands::start(const service::PendingCommand& command, Job job) {
  if (settled_ < started_) return command.answer({false, "busy: another map is being saved or loaded"});
  const auto deadline = Clock::now() + limit_;
  under_way_ = UnderWay{++started_, deadline, command.answer};
  orders_.push({started_, deadline, std::move(job)});
}

void MapCommands::save(const service::PendingCommand& command, const std::function<map_file::MapPart()>& make,
                       const std::string& what) {
  const auto order = parse_save(command, own_part_);
  if (!order) return command.answer({false, order.error()});
  if (settled_ < started_) return start(command, {});  // before it is made
  const auto part = std::make_shared<map_file::MapPart>(make());
  start(command, [this, order = *order, part, what](const map_file::FileLimits& limits) {
    const auto maps = make_maps_folder(config_);
    if (!maps) return answer(false, maps.error());
    const auto state = map_file::save_part(*maps, order, std::move(*part), limits);
    if (!state) return answer(false, state.error());
    return answer(true, save_answer(order, *state, *maps, what));
  });
}

void MapCommands::load(const service::PendingCommand& command, Read read) {
  if (const auto checked = map_file::check_map_name(command.argument); !checked)
    return command.answer({false, checked.error()});
  start(command,
        [this, name = command.argument,
         read = std::move(read)](const map_file::FileLimits& limits) -> Completion {
          const auto maps = store::maps_folder(config_);
          const auto map = maps ? map_file::open_map(*maps, name) : tl::unexpected(maps.error());
          if (!map) return answer(false, map.error());
          auto taken = read(*map, limits);
          return taken ? std::move(*taken) : answer(false, taken.error());
        });
}

bool MapCommands::locked_ready() const {
  return !done_.locked_empty() || (under_way_ && Clock::now() > under_way_->deadline);
}

void MapCommands::settle() {
  if (const auto done = done_.try_pop()) {
    settled_ = done->number;
    if (!under_way_) return;  // answered already
    const auto order = std::exchange(under_way_, std::nullopt);
    try {
      order->answer(done->complete());
    } catch (const std::exception& e) {
      order->answer({false, e.what()});
    }
  } else if (under_way_ && Clock::now() > under_way_->deadline) {
    const auto limit_s = std::chrono::duration<double>(limit_).count();
    std::exchange(under_way_, std::nullopt)->answer({false, fmt::format("not done within {} s", limit_s)});
  }
}

}  // namespace rds::map_commands
