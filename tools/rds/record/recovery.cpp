// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/record/recovery.hpp"

#include <fmt/format.h>

#include "tools/recording/bag/mcap_bag.hpp"
#include "tools/recording/bag/mcap_bag_writer.hpp"
#include "tools/recording/conversion.hpp"

namespace rds::record {
namespace fs = std::filesystem;

tl::expected<Recovered, std::string> recover(const fs::path& file, mcap::Compression compression) {
  auto bag = recording::McapBag::open(file);
  if (!bag) return tl::unexpected(bag.error());
  const auto scan = (*bag)->scan([](auto&&...) {});
  if (!scan) return tl::unexpected(scan.error());
  if (scan->fault.empty()) return Recovered{scan->messages};
  fs::path partial = file;
  partial += ".recovered";
  auto writer = recording::McapBagWriter::make(partial, compression);
  if (!writer) return tl::unexpected(writer.error());
  const auto copied = recording::copy_bag(**bag, **writer);
  std::error_code error;
  if (copied) fs::rename(partial, file, error);
  if (copied && !error) return Recovered{copied->items, scan->fault};
  const std::string sentence =
      copied ? fmt::format("{}: cannot be replaced: {}", file.string(), error.message()) : copied.error();
  fs::remove(partial, error);
  return tl::unexpected(sentence);
}

}  // namespace rds::record
