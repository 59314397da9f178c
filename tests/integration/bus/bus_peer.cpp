// SPDX-License-Identifier: Apache-2.0
// One process on the bus, for the tests in Python; it stays until its standard input closes.
//   bus_peer MODE VENDOR DOMAIN …
//   reader                says the name (frame_id) of each picture it gets, "torn" of one made of several
//   slow                  as reader, but takes .2 s for each
//   talker                writes ten small pictures a second, named "VENDOR NUMBER"
//   writer READERS COUNT  waits for its readers, writes COUNT pictures of 1.5 MB at 30 Hz, then says
//                         {"refused": n, "write": times, "copy": times}
//   census COUNT          says {"seconds": t} when it has discovered COUNT of its kind
//   keeper COUNT          writes the numbers below COUNT, ten a second; late readers get the last 100
//   teller DEPTH          writes each line of its standard input; late readers get the last DEPTH
//   late                  says each number or line that it gets
//   meter                 reads these numbers and pictures, and says five times a second
//                         {"number": {"messages": n, "dropped": n}, "picture": {"messages": n, "dropped": n}}
//   server                serves "switch" (std_srvs/srv/SetBool), and answers what it was asked
// --network before these: with multicast and on every interface, as services are; else on 127.0.0.1.
// --peers LIST before these: as --network, and with these peers.
// --secure FOLDER IDENTITY before these: in a secured domain.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "common/bus/peer_addresses.hpp"
#include "common/bus/service_server.hpp"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "std_msgs/msg/String.h"
#include "std_srvs/srv/SetBool_Request.h"
#include "std_srvs/srv/SetBool_Response.h"

namespace {

using rds::bus::Participant;
using sensor_msgs::msg::Image;
using std_msgs::msg::String;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void stay() {
  for (std::string line; std::getline(std::cin, line);) {
  }
}

/// All bytes of a picture are the same.
bool is_torn(const std::vector<std::uint8_t>& data) {
  return !data.empty() && std::memcmp(data.data(), data.data() + 1, data.size() - 1) != 0;
}

void read(Participant& participant, std::chrono::milliseconds pause = {}) {
  auto subscription = participant.subscribe<Image>(
      "picture", rds::bus::kSensor, [pause](const std::shared_ptr<const Image>& image) {
        std::cout << (is_torn(image->data()) ? "torn" : image->header().frame_id()) << std::endl;
        std::this_thread::sleep_for(pause);
      });
  stay();
}

/// How long the calls of one kind took.
class CallTimes {
 public:
  template <class Call>
  void time(Call call) {
    const auto start = Clock::now();
    const double processor = processor_s();
    call();
    processor_s_ = std::max(processor_s_, processor_s() - processor);
    const double clock_s = seconds_since(start);
    slowest_s_ = std::max(slowest_s_, clock_s);
    over_2_ms_ += clock_s > .002 ? 1 : 0;
  }
  /// The slowest, the most processor time of one, and how many took more than 2 ms.
  [[nodiscard]] std::string json() const {
    return R"({"slowest_ms": )" + std::to_string(1e3 * slowest_s_) + R"(, "processor_ms": )" +
           std::to_string(1e3 * processor_s_) + R"(, "over_2_ms": )" + std::to_string(over_2_ms_) + "}";
  }

 private:
  static double processor_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double slowest_s_ = 0;
  double processor_s_ = 0;
  int over_2_ms_ = 0;
};

void write(Participant& participant, int readers, int count) {
  auto publisher = participant.advertise<Image>("picture", rds::bus::kSensor);
  while (publisher.matched() < readers) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  Image image;
  constexpr std::size_t kSize = 1'500'000;
  int refused = 0;
  CallTimes writes;
  CallTimes copies;  // of as many bytes: what the machine itself costs
  for (int i = 0; i < count; ++i) {
    image.header().frame_id(std::to_string(i));
    image.data().assign(kSize, static_cast<std::uint8_t>(i));
    const auto start = Clock::now();
    writes.time([&] { refused += publisher.write(image) ? 0 : 1; });
    copies.time([&] { const std::vector<std::uint8_t> copy(image.data()); });
    std::this_thread::sleep_until(start + std::chrono::milliseconds(33));
  }
  std::cout << R"({"refused": )" << refused << R"(, "write": )" << writes.json() << R"(, "copy": )"
            << copies.json() << "}" << std::endl;
  stay();
}

void talk(Participant& participant, const std::string& name) {
  auto publisher = participant.advertise<Image>("picture", rds::bus::kSensor);
  const std::jthread writer([&](const std::stop_token& stop) {
    Image image;
    for (int i = 0; !stop.stop_requested(); ++i) {
      image.header().frame_id(name + " " + std::to_string(i));
      publisher.write(image);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  stay();
}

void census(Participant& participant, std::ptrdiff_t count, Clock::time_point start) {
  auto publisher = participant.advertise<std_msgs::msg::Header>("census", rds::bus::kStream);
  const auto known = [&participant] {
    const auto endpoints = participant.discovered();
    return std::count_if(endpoints.begin(), endpoints.end(),
                         [](const auto& e) { return e.topic == "census"; });
  };
  while (known() < count) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::cout << R"({"seconds": )" << seconds_since(start) << "}" << std::endl;
  stay();
}

void keep(Participant& participant, int count) {
  auto publisher = participant.advertise<String>("number", rds::bus::kLatchedEvery);
  const std::jthread writer([&](const std::stop_token& stop) {
    String number;
    for (int i = 0; i < count && !stop.stop_requested(); ++i) {
      number.data(std::to_string(i));
      publisher.write(number);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  stay();
}

void tell(Participant& participant, int depth) {
  auto publisher = participant.advertise<String>("number", {.transient_local = true, .depth = depth});
  String text;
  while (std::getline(std::cin, text.data())) publisher.write(text);
}

void join_late(Participant& participant) {
  auto subscription = participant.subscribe<String>(
      "number", rds::bus::kLatchedEvery,
      [](const std::shared_ptr<const String>& number) { std::cout << number->data() << std::endl; });
  stay();
}

void measure(Participant& participant) {
  const auto ignore = [](const auto&) {};
  const auto numbers =
      participant.subscribe<String>("number", rds::bus::kLatchedEvery, ignore);
  const auto pictures = participant.subscribe<Image>("picture", rds::bus::kSensor, ignore);
  const std::jthread speaker([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      nlohmann::json counts;
      for (const auto& topic : participant.statistics())
        counts[topic.topic] = {{"messages", topic.messages}, {"dropped", topic.dropped}};
      std::cout << counts.dump() << std::endl;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
  });
  stay();
}

void serve(Participant& participant) {
  using std_srvs::srv::SetBool_Request;
  using std_srvs::srv::SetBool_Response;
  const auto server = rds::bus::serve<SetBool_Request, SetBool_Response>(
      participant, "switch", [](const SetBool_Request& request) {
        SetBool_Response response;
        response.success(request.data());
        response.message(request.data() ? "on" : "off");
        return response;
      });
  stay();
}

/// Takes what stands before the mode.
rds::bus::ParticipantOptions take_options(std::vector<std::string>& arguments) {
  rds::bus::ParticipantOptions options{.node_name = "bus_peer", .loopback_only = true};
  std::size_t taken = 0;
  for (; arguments.at(taken).starts_with("--"); ++taken) {
    const std::string option = arguments.at(taken);
    if (option == "--secure") {
      auto credentials = rds::bus::read_credentials(arguments.at(taken + 1), arguments.at(taken + 2));
      if (!credentials) throw std::runtime_error(credentials.error());
      options.credentials = *credentials;
      taken += 2;
      continue;
    }
    options.loopback_only = false;
    if (option == "--peers") options.peers = rds::bus::peer_addresses(arguments.at(++taken));
  }
  arguments.erase(arguments.begin(), arguments.begin() + static_cast<std::ptrdiff_t>(taken));
  return options;
}

int run(std::vector<std::string> arguments) {
  const auto start = Clock::now();
  rds::bus::ParticipantOptions options = take_options(arguments);
  const std::string& mode = arguments.at(0);
  options.vendor = rds::bus::vendor_from_name(arguments.at(1));
  options.domain = std::stoi(arguments.at(2));
  const auto participant = Participant::create(options);
  if (mode == "reader") read(*participant);
  if (mode == "slow") read(*participant, std::chrono::milliseconds(200));
  if (mode == "talker") talk(*participant, arguments.at(1));
  if (mode == "writer") write(*participant, std::stoi(arguments.at(3)), std::stoi(arguments.at(4)));
  if (mode == "keeper") keep(*participant, std::stoi(arguments.at(3)));
  if (mode == "teller") tell(*participant, std::stoi(arguments.at(3)));
  if (mode == "late") join_late(*participant);
  if (mode == "meter") measure(*participant);
  if (mode == "server") serve(*participant);
  if (mode == "census") census(*participant, std::stoi(arguments.at(3)), start);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const std::exception& error) {
    std::cerr << "bus_peer: " << error.what() << '\n';
    return 2;
  }
}
