// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rds::test {

/// An interface's end of a userspace link: takes every frame that comes out of it, and puts frames in. Frames
/// carry the kernel's header about what is left to do (checksum, segments), so that one which was never
/// on a cable is valid at the other end, too.
class PacketPort {
 public:
  /// @throws std::runtime_error naming the interface.
  explicit PacketPort(const std::string& interface);
  ~PacketPort();
  PacketPort(const PacketPort&) = delete;
  PacketPort& operator=(const PacketPort&) = delete;

  /// Does not wait. @return nullopt if there is none.
  std::optional<std::vector<std::uint8_t>> receive();
  /// Does not wait: as on a switch, what does not fit into the queue is lost.
  void send(const std::vector<std::uint8_t>& frame);
  /// For poll().
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

}  // namespace rds::test
