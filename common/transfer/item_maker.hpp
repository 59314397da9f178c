// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// Makes items when somebody asks for them. All members are called on one thread, the server's.
class ItemMaker {
 public:
  struct Offers {
    std::uint64_t map_epoch = 0;  // tells the items of one map from those of another
    std::map<Stream, Offer> streams;

    bool operator==(const Offers&) const = default;
  };

  virtual ~ItemMaker() = default;
  /// What can be asked for from now on. @param has_readers  somebody has asked lately.
  virtual Offers offers(bool has_readers) = 0;
  /// The same bytes for the same number as long as it is asked for; nullptr: it cannot be had.
  virtual const std::vector<std::uint8_t>* find(Stream stream, std::uint64_t number) = 0;
};

}  // namespace rds::transfer
