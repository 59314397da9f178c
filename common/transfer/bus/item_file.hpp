// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/store/scratch_file.hpp"
#include "common/transfer/item_store.hpp"

namespace rds::transfer {

/// Items in a scratch file, in the system's folder for temporary files (TMPDIR).
class ItemFile : public ItemSpill {
 public:
  bool put(Stream stream, std::uint64_t number, const Bytes& item) override;
  std::optional<Bytes> get(Stream stream, std::uint64_t number) override;
  void erase(Stream stream, std::uint64_t number) override;
  void clear() override { file_.clear(); }

 private:
  store::ScratchFile file_;
};

}  // namespace rds::transfer
