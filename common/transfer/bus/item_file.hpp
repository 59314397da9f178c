// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/store/store.hpp"
#include "common/transfer/item_store.hpp"

namespace rds::transfer {

/// A temporary file without a name for items: it goes with the process, however that ends. Made at the first
/// put(), in the system's folder for temporary files (TMPDIR).
class ItemFile : public ItemSpill {
 public:
  bool put(Stream stream, std::uint64_t number, const Bytes& item) override;
  std::optional<Bytes> get(Stream stream, std::uint64_t number) override;
  void erase(Stream stream, std::uint64_t number) override;
  void clear() override { file_.reset(); }

 private:
  std::optional<store::Store> file_;
};

}  // namespace rds::transfer
