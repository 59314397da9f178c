// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <limits>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/compression_option.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/cli/interrupt.hpp"
#include "tools/rds/cli/wait.hpp"
#include "tools/rds/record/recovery.hpp"
#include "tools/rds/record/topic_subscriptions.hpp"

namespace rds::record {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kForEver = std::numeric_limits<double>::infinity();
constexpr std::chrono::hours kLongest{24 * 365};
constexpr std::size_t kQueueBytes = std::size_t{256} << 20;  // five seconds of raw pictures at 30 Hz

struct RecordOptions {
  std::filesystem::path file;
  std::vector<std::string> topics;
  bool camera = false;
  bool all = false;
  bool force = false;
  bool recover = false;
  double seconds = kForEver;
  mcap::Compression compression = mcap::Compression::kLz4;
  BusOptions bus;
};

TopicChoice chosen(const RecordOptions& options) {
  if (options.all) return TopicChoice::all();
  if (options.camera) return TopicChoice::camera();
  return options.topics.empty() ? TopicChoice::camera_and_outputs() : TopicChoice::named(options.topics);
}

Clock::time_point end_of(const RecordOptions& options) {
  if (options.seconds == kForEver) return Clock::now() + kLongest;
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.seconds));
}

/// @return how many messages were written.
std::uint64_t print_counts(const RecordOptions& options, const BagThread& bag, std::uint64_t lost) {
  std::uint64_t messages = 0;
  std::uint64_t dropped = 0;
  for (const auto& count : bag.counts()) {
    fmt::print("{:<44} {:>8} messages, {:.1f} MB\n", count.topic.name, count.messages,
               static_cast<double>(count.bytes) / 1e6);
    messages += count.messages;
    dropped += count.dropped;
  }
  fmt::print("{}: {} messages, {} dropped, {} lost by the bus\n", options.file.string(), messages, dropped,
             lost);
  return messages;
}

void record(const RecordOptions& options) {
  std::error_code error;
  if (std::filesystem::exists(options.file, error) && !options.force)
    tools::exit_with(tools::kExitBadInput,
                     fmt::format("{}: is there already; --force overwrites it", options.file.string()));
  const Interrupt interrupt;
  BagThread bag(tools::value_or_exit(recording::make_bag_writer(options.file, options.compression)),
                kQueueBytes);
  std::set<std::string> unknown;
  std::uint64_t lost = 0;
  {
    TopicSubscriptions subscriptions(options.bus.participant("rds_record"), chosen(options), bag);
    tools::wait_until(end_of(options), interrupt.token(), [&] {
      subscriptions.look();
      return bag.failed();
    });
    unknown = subscriptions.unknown();
    lost = subscriptions.lost();
  }
  const auto finished = bag.finish();
  for (const std::string& topic : unknown)
    fmt::print(stderr, "rds: {}: not recorded, as no file of idl/ defines its type\n", topic);
  const std::uint64_t messages = print_counts(options, bag, lost);
  if (!finished) tools::exit_with(tools::kExitBadInput, finished.error());
  if (messages == 0) tools::exit_with(tools::kExitFault, "nobody has published any of these topics");
}

void recover_file(const RecordOptions& options) {
  const auto recovered = tools::value_or_exit(recover(options.file, options.compression));
  if (recovered.fault.empty())
    fmt::print("{}: whole, {} messages; left as it is\n", options.file.string(), recovered.messages);
  else
    fmt::print("{}; {} messages recovered\n", recovered.fault, recovered.messages);
}

}  // namespace

void add_record_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("record", "Record topics into an MCAP file, until Ctrl-C");
  const auto options = std::make_shared<RecordOptions>();
  command->add_option("file", options->file, "File to write, which ends in .mcap (or in .db3)")->required();
  auto* topics = command->add_option("topics", options->topics,
                                     "Topics (default: the camera and what the services say)");
  auto* camera = command->add_flag("--camera", options->camera, "The camera's topics only")->excludes(topics);
  command->add_flag("--all", options->all, "All topics of the domain")->excludes(topics)->excludes(camera);
  command->add_option("--seconds", options->seconds, "End after so long [s] (default: never)")
      ->check(CLI::Range(0.1, 1e7));
  add_compression_option(*command, options->compression);
  command->add_flag("--force", options->force, "Overwrite a file that is there");
  command->add_flag("--recover", options->recover, "Make a file whole that was torn, and record nothing");
  add_bus_options(*command, options->bus);
  command->callback([options] {
    try {
      if (options->recover)
        recover_file(*options);
      else
        record(*options);
    } catch (const bus::BusError& e) {
      tools::exit_with(tools::kExitBadInput, e.what());
    }
  });
}

}  // namespace rds::record
