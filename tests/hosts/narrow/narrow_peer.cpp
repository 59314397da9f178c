// SPDX-License-Identifier: Apache-2.0
// Pictures (.9 MB, 10 a second) beside small messages (100 B, 50 a second), for 10 s.
//   narrow_peer write VENDOR DOMAIN PEER   once the reader is there; then {"slowest_picture_ms": t,
//   "slowest_small_ms": t} narrow_peer read VENDOR DOMAIN PEER    until the writer has left; then
//   {"pictures": n, "picture_p50_ms": t,
//                                          "small": n, "small_p50_ms": t, "small_p99_ms": t}
// Latencies from write() to callback, on one machine's clock.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"

namespace {

using rds::bus::Participant;
using sensor_msgs::msg::Image;
using std_msgs::msg::Header;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kDuration = 10s;
constexpr std::size_t kPictureBytes = 900'000;
constexpr std::size_t kSmallBytes = 80;  // with header and stamp 100

std::string now() {
  return std::to_string(Clock::now().time_since_epoch().count());
}

class Latencies {
 public:
  void add(const std::string& sent) {
    const Clock::duration taken = Clock::now().time_since_epoch() - Clock::duration(std::stoll(sent));
    const std::lock_guard lock(mutex_);
    ms_.push_back(std::chrono::duration<double, std::milli>(taken).count());
  }
  std::vector<double> sorted() {
    const std::lock_guard lock(mutex_);
    std::ranges::sort(ms_);
    return ms_;
  }

 private:
  std::mutex mutex_;
  std::vector<double> ms_;
};

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return -1;
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

/// Writes at this period, named by the time. @return how long the slowest call took [ms].
template <class Message, class Stamp>
double write_all(rds::bus::Publisher<Message>& publisher, Message message, Clock::duration period,
                 Stamp stamp) {
  double slowest_ms = 0;
  auto next = Clock::now();
  for (const auto end = next + kDuration; next < end; next += period) {
    std::this_thread::sleep_until(next);
    stamp(message);
    const auto start = Clock::now();
    publisher.write(message);
    slowest_ms =
        std::max(slowest_ms, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return slowest_ms;
}

void write(Participant& participant) {
  auto pictures = participant.advertise<Image>("picture", rds::bus::kSensor);
  auto small = participant.advertise<Header>("small", rds::bus::kStream);
  while (pictures.matched() == 0 || small.matched() == 0) std::this_thread::sleep_for(10ms);
  std::this_thread::sleep_for(1s);
  Image image;
  image.data().assign(kPictureBytes, 1);
  double slowest_picture_ms = 0;
  std::thread camera([&] {
    slowest_picture_ms = write_all(pictures, image, 100ms, [](Image& i) { i.header().frame_id(now()); });
  });
  const double slowest_small_ms = write_all(small, Header{}, 20ms, [](Header& h) {
    std::string text = now();
    text.resize(kSmallBytes, ' ');
    h.frame_id(text);
  });
  camera.join();
  std::cout << nlohmann::json{{"slowest_picture_ms", slowest_picture_ms},
                              {"slowest_small_ms", slowest_small_ms}}
            << std::endl;
  std::this_thread::sleep_for(3s);  // for what is on its way
}

void read(Participant& participant) {
  Latencies picture;
  Latencies small;
  const auto pictures = participant.subscribe<Image>(
      "picture", rds::bus::kSensor,
      [&](const std::shared_ptr<const Image>& image) { picture.add(image->header().frame_id()); });
  const auto smalls = participant.subscribe<Header>(
      "small", rds::bus::kStream,
      [&](const std::shared_ptr<const Header>& header) { small.add(header->frame_id()); });
  while (smalls.matched() == 0) std::this_thread::sleep_for(10ms);
  while (smalls.matched() > 0) std::this_thread::sleep_for(10ms);
  const auto picture_ms = picture.sorted();
  const auto small_ms = small.sorted();
  std::cout << nlohmann::json{{"pictures", picture_ms.size()},
                              {"picture_p50_ms", quantile(picture_ms, .5)},
                              {"small", small_ms.size()},
                              {"small_p50_ms", quantile(small_ms, .5)},
                              {"small_p99_ms", quantile(small_ms, .99)}}
            << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const auto participant = Participant::create({.vendor = rds::bus::vendor_from_name(arguments.at(1)),
                                                  .domain = std::stoi(arguments.at(2)),
                                                  .node_name = "narrow_peer_" + arguments.at(0),
                                                  .peers = {arguments.at(3)}});
    arguments.at(0) == "write" ? write(*participant) : read(*participant);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "narrow_peer: " << error.what() << '\n';
    return 2;
  }
}
