// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "common/bus/type_ops.hpp"

namespace rds::bus::detail {

/// Messages to decode into. A message that its last user has let go of is used again, with the memory of its
/// sequences: a stream of pictures neither allocates nor clears memory. Messages may outlive the pool and its
/// type.
class MessagePool {
 public:
  explicit MessagePool(const TypeOps& type) : shelf_(std::make_shared<Shelf>(type)) {}

  std::shared_ptr<void> get() {
    return {shelf_->take(), [shelf = shelf_](void* message) { shelf->put_back(message); }};
  }
  /// Forgets what waits to be used again.
  void clear() { shelf_->clear(); }

 private:
  static constexpr std::size_t kKept = 2;

  struct Shelf {
    explicit Shelf(const TypeOps& type) : create(type.create), destroy(type.destroy) {}
    Shelf(const Shelf&) = delete;
    Shelf& operator=(const Shelf&) = delete;
    ~Shelf() { clear(); }
    void clear() {
      const std::lock_guard lock(mutex);
      for (void* message : unused) destroy(message);
      unused.clear();
    }
    void* take() {
      const std::lock_guard lock(mutex);
      if (unused.empty()) return create();
      void* message = unused.back();
      unused.pop_back();
      return message;
    }
    void put_back(void* message) {
      const std::lock_guard lock(mutex);
      if (unused.size() < kKept) {
        unused.push_back(message);
      } else {
        destroy(message);
      }
    }
    void* (*create)();
    void (*destroy)(void*);
    std::mutex mutex;
    std::vector<void*> unused;
  };

  std::shared_ptr<Shelf> shelf_;
};

}  // namespace rds::bus::detail
