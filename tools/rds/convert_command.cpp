// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "tools/rds/cli/commands.hpp"
#include "tools/rds/cli/compression_option.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::tools {
namespace {
namespace fs = std::filesystem;
using recording::Converted;

struct ConvertOptions {
  fs::path from;
  fs::path to;
  mcap::Compression compression = mcap::Compression::kLz4;
  bool force = false;
};

bool is_bag_file(const fs::path& path) {
  return path.extension() == ".mcap" || path.extension() == ".db3";
}

/// Nothing is overwritten unasked, and nothing onto itself.
void check_target(const ConvertOptions& options) {
  std::error_code error;
  if (!fs::exists(options.to, error)) return;
  if (fs::equivalent(options.from, options.to, error))
    exit_with(kExitBadInput, fmt::format("{}: expected another place to write to", options.to.string()));
  const bool is_empty_folder = fs::is_directory(options.to, error) && fs::is_empty(options.to, error);
  if (!options.force && !is_empty_folder)
    exit_with(kExitBadInput, fmt::format("{}: is there already; --force overwrites it", options.to.string()));
}

Converted convert_to_folder(const ConvertOptions& options) {
  const auto opened = value_or_exit(recording::open_recording(options.from));
  fmt::print(stderr, "{}", opened.notes);
  return value_or_exit(recording::write_tum_folder(*opened.recording, options.to));
}

tl::expected<Converted, std::string> write_bag(const ConvertOptions& options, recording::BagWriter& writer) {
  if (recording::is_bag(options.from)) {
    auto bag = recording::open_bag(options.from);
    if (!bag) return tl::unexpected(bag.error());
    return recording::copy_bag(**bag, writer);
  }
  const auto opened = recording::open_recording(options.from);
  if (!opened) return tl::unexpected(opened.error());
  return recording::write_bag(*opened->recording, writer);
}

Converted convert_to_bag(const ConvertOptions& options) {
  std::error_code error;
  if (!fs::exists(options.from, error))
    exit_with(kExitBadInput, fmt::format("{}: no such recording", options.from.string()));
  auto writer = value_or_exit(recording::make_bag_writer(options.to, options.compression));
  auto converted = write_bag(options, *writer);
  if (!converted) fs::remove(options.to, error);
  return value_or_exit(std::move(converted));
}

void convert(const ConvertOptions& options) {
  check_target(options);
  const bool to_bag = is_bag_file(options.to);
  const Converted converted = to_bag ? convert_to_bag(options) : convert_to_folder(options);
  fmt::print("{}: {} {} written\n", options.to.string(), converted.items, to_bag ? "messages" : "pictures");
  if (converted.unreadable > 0)
    fmt::print(stderr, "rds: {} pictures cannot be read and were left out; {}\n", converted.unreadable,
               converted.fault);
  else if (!converted.fault.empty())
    fmt::print(stderr, "rds: {}\n", converted.fault);
}

}  // namespace

void add_convert_command(CLI::App& rds) {
  auto* command = rds.add_subcommand("convert", "Write a recording in another form");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("from", options->from, "Recording, in any form that rds run reads")->required();
  command
      ->add_option("to", options->to,
                   "A file that ends in .mcap or .db3, or a folder, which is written in TUM form")
      ->required();
  add_compression_option(*command, options->compression);
  command->add_flag("--force", options->force, "Overwrite what is there");
  command->callback([options] { convert(*options); });
}

}  // namespace rds::tools
