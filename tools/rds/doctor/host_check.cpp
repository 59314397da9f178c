// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/host_check.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/geometry/text_line.hpp"
#include "services/detector/models/model_store.hpp"

namespace rds::doctor {
namespace {
constexpr unsigned kFewestCores = 2;
constexpr double kGiB = 1024.0 * 1024 * 1024;
constexpr double kLeastMemoryGiB = 1.5;
constexpr double kLeastDiskGiB = 1.0;
constexpr long kWantedBufferBytes = 4 * 1024 * 1024;
constexpr int kHighestDomain = 232;  // above it DDS ports pass 65535
constexpr int kEchoTimeoutMs = 500;

/// The text behind `key` and a colon in a file such as /proc/cpuinfo.
std::optional<std::string> field_of(const std::filesystem::path& file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos && line.starts_with(key))
      return line.substr(std::min(colon + 2, line.size()));
  }
  return std::nullopt;
}

/// A UDP socket that closes itself.
class Socket {
 public:
  Socket() : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  template <class Value>
  [[nodiscard]] bool set(int option, const Value& value) const {
    return setsockopt(fd_, IPPROTO_IP, option, &value, sizeof(value)) == 0;
  }
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

/// Sends one datagram to a group on the loopback interface and waits for its echo.
bool multicast_echoes() {
  const Socket socket;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof(address);
  ip_mreq group{};
  group.imr_multiaddr.s_addr = inet_addr("239.255.0.1");
  group.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
  const bool ready = bind(socket.fd(), reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
                     socket.set(IP_ADD_MEMBERSHIP, group) &&
                     socket.set(IP_MULTICAST_IF, group.imr_interface) && socket.set(IP_MULTICAST_LOOP, 1);
  if (!ready) return false;
  address.sin_addr = group.imr_multiaddr;
  const char hello = 'h';
  if (sendto(socket.fd(), &hello, 1, 0, reinterpret_cast<sockaddr*>(&address), size) != 1) return false;
  pollfd waiting{.fd = socket.fd(), .events = POLLIN, .revents = 0};
  return poll(&waiting, 1, kEchoTimeoutMs) == 1;
}

}  // namespace

Finding check_processor() {
  const unsigned cores = std::thread::hardware_concurrency();
  const auto model = field_of("/proc/cpuinfo", "model name").value_or("unknown model");
  const auto flags = field_of("/proc/cpuinfo", "flags").value_or("");
  std::string features;
  for (const char* feature : {"sse4_2", "avx2", "fma", "avx512f"})
    if ((flags + " ").find(fmt::format(" {} ", feature)) != std::string::npos)
      features += fmt::format(" {}", feature);
  return {cores < kFewestCores ? Verdict::kHint : Verdict::kGood, "processor",
          fmt::format("{} cores, {}{}{}", cores, model, features.empty() ? "" : ", has", features)};
}

Finding check_memory() {
  const std::string text = field_of("/proc/meminfo", "MemAvailable").value_or("");
  const auto words = geometry::split_words(text);
  const auto kib = words.empty() ? std::nullopt : geometry::parse_number(words.front());
  if (!kib) return {Verdict::kHint, "memory", "/proc/meminfo does not tell what is free"};
  const double gib = *kib * 1024 / kGiB;
  return {gib < kLeastMemoryGiB ? Verdict::kHint : Verdict::kGood, "memory",
          fmt::format("{:.1f} GiB free, expected at least {} GiB", gib, kLeastMemoryGiB)};
}

Finding check_disk(const std::filesystem::path& folder) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  if (error) return {Verdict::kFault, "disk", fmt::format("{}: {}", folder.string(), error.message())};
  const double gib = static_cast<double>(space.available) / kGiB;
  return {gib < kLeastDiskGiB ? Verdict::kHint : Verdict::kGood, "disk",
          fmt::format("{:.1f} GiB free in {}", gib, folder.string())};
}

Finding check_receive_buffer() {
  std::ifstream in("/proc/sys/net/core/rmem_max");
  long bytes = 0;
  if (!(in >> bytes)) return {Verdict::kHint, "receive buffer", "net.core.rmem_max cannot be read"};
  if (bytes >= kWantedBufferBytes)
    return {Verdict::kGood, "receive buffer", fmt::format("up to {} bytes", bytes)};
  return {Verdict::kHint, "receive buffer",
          fmt::format("net.core.rmem_max is {} bytes; pictures over the bus are faster after `sysctl -w "
                      "net.core.rmem_max={}`",
                      bytes, kWantedBufferBytes)};
}

Finding check_loopback_multicast() {
  if (multicast_echoes()) return {Verdict::kGood, "multicast", "works on the loopback interface"};
  return {Verdict::kHint, "multicast",
          "does not work on the loopback interface: services started by hand find each other after `ip link "
          "set lo "
          "multicast on`; `rds run` needs none"};
}

Finding check_domain(const char* ros_domain_id) {
  if (ros_domain_id == nullptr) return {Verdict::kGood, "domain", "ROS_DOMAIN_ID is not set, 0 is used"};
  const auto number = geometry::parse_number(ros_domain_id);
  if (number && *number == static_cast<int>(*number) && *number >= 0 && *number <= kHighestDomain)
    return {Verdict::kGood, "domain", fmt::format("ROS_DOMAIN_ID is {}", ros_domain_id)};
  return {
      Verdict::kFault, "domain",
      fmt::format("ROS_DOMAIN_ID is {}, expected 0 … {}", geometry::shown(ros_domain_id), kHighestDomain)};
}

Finding check_networks() {
  const auto folders = detector::model_folders();
  std::string found;
  for (const auto& network : detector::shipped_networks())
    if (detector::find_file(network, folders)) found += (found.empty() ? "" : ", ") + network.name;
  if (found.empty())
    return {Verdict::kFault, "networks",
            "none found: people are not detected; `rds models fetch` brings one"};
  return {Verdict::kGood, "networks",
          fmt::format("{} found, {} is used, computed by {}", found, detector::default_network(folders),
                      detector::backends().front())};
}

Finding check_vendor(bus::Vendor vendor) {
  const std::string subject = bus::name_of(vendor);
  try {
    const auto participant = bus::Participant::create(
        {.vendor = vendor, .domain = 0, .node_name = "rds_doctor", .loopback_only = true});
    return {Verdict::kGood, subject, "joins a bus on this machine"};
  } catch (const std::exception& e) {
    // Zenoh may be left out of a build, and nothing else misses it.
    return {vendor == bus::Vendor::kZenoh ? Verdict::kHint : Verdict::kFault, subject,
            fmt::format("cannot join a bus: {}", e.what())};
  }
}

std::vector<Finding> check_host() {
  return {check_processor(),
          check_memory(),
          check_disk(std::filesystem::current_path()),
          check_receive_buffer(),
          check_loopback_multicast(),
          check_domain(std::getenv("ROS_DOMAIN_ID")),
          check_vendor(bus::Vendor::kFastDds),
          check_vendor(bus::Vendor::kCycloneDds),
          check_vendor(bus::Vendor::kZenoh),
          check_networks()};
}

}  // namespace rds::doctor
