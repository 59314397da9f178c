// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/bag/bag_writer.hpp"

#include <fmt/format.h>

#include "tools/recording/bag/db3_bag_writer.hpp"
#include "tools/recording/bag/mcap_bag_writer.hpp"

namespace rds::recording {

tl::expected<std::unique_ptr<BagWriter>, std::string> make_bag_writer(const std::filesystem::path& file,
                                                                      mcap::Compression compression) {
  if (file.extension() == ".mcap") return McapBagWriter::make(file, compression);
  if (file.extension() == ".db3") return Db3BagWriter::make(file);
  return tl::unexpected(fmt::format("{}: expected a name that ends in .mcap or .db3", file.string()));
}

}  // namespace rds::recording
