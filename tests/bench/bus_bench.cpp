// SPDX-License-Identifier: Apache-2.0
// Latency from write() to the callback in another process over 127.0.0.1, for every pair of vendors that
// hear each other, for each bus on a secured domain, and for Zenoh in shared memory.
// The reader runs as a child process, because Cyclone DDS takes a short cut between participants of one
// process.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/bus/domain_lock.hpp"
#include "common/bus/participant.hpp"
#include "sensor_msgs/msg/Image.h"
#include "std_msgs/msg/Header.h"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/secure/secure_folder.hpp"

extern char** environ;

namespace rds::bus {
namespace {

using sensor_msgs::msg::Image;
using std_msgs::msg::Header;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Topics that a secured domain's player may write and read, and its tracker read and write.
constexpr const char* kPicture = "camera/color/image_raw";
constexpr const char* kAnswer = "rds/tracking_state";

/// @param secured  folder of a secured domain; empty: the bus is open.
std::unique_ptr<Participant> join(Vendor vendor, int domain, const std::string& secured,
                                  const std::string& identity) {
  ParticipantOptions options{
      .vendor = vendor, .domain = domain, .node_name = "bus_bench_" + identity, .loopback_only = true};
  if (!secured.empty()) options.credentials = read_credentials(secured, identity).value();
  return Participant::create(options);
}

/// The child: answers each picture with its latency and the CPU time used so far, until the writer leaves.
int run_reader(const std::string& vendor, int domain, const std::string& secured) {
  auto participant = join(vendor_from_name(vendor), domain, secured, "tracker");
  auto answers = participant->advertise<Header>(kAnswer, kStream);
  auto subscription =
      participant->subscribe<Image>(kPicture, kSensor, [&](const std::shared_ptr<const Image>& image) {
        Header answer;
        const std::int64_t sent = std::stoll(image->header().frame_id());
        answer.stamp().nanosec(static_cast<std::uint32_t>(now_ns() - sent));
        answer.frame_id(std::to_string(cpu_seconds()));
        answers.write(answer);
      });
  while (answers.matched() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  while (answers.matched() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return 0;
}

class ReaderProcess {
 public:
  ReaderProcess(Vendor vendor, int domain, std::string secured) {
    std::string self = "/proc/self/exe";
    std::string mode = "reader";
    std::string name = name_of(vendor);
    std::string number = std::to_string(domain);
    char* const arguments[] = {self.data(), mode.data(), name.data(), number.data(), secured.data(), nullptr};
    if (posix_spawn(&pid_, self.c_str(), nullptr, nullptr, arguments, environ) != 0) {
      throw std::runtime_error("cannot start the reader process");
    }
  }
  ~ReaderProcess() { waitpid(pid_, nullptr, 0); }
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

 private:
  pid_t pid_ = 0;
};

/// The newest answer of the reader process.
struct Answers {
  std::mutex mutex;
  std::condition_variable arrived;
  std::size_t count = 0;
  double latency_s = 0;
  double reader_cpu_s = 0;

  void receive(const Header& answer) {
    const std::lock_guard lock(mutex);
    ++count;
    latency_s = 1e-9 * answer.stamp().nanosec();
    reader_cpu_s = std::stod(answer.frame_id());
    arrived.notify_one();
  }
  bool wait_beyond(std::size_t seen) {
    std::unique_lock lock(mutex);
    return arrived.wait_for(lock, std::chrono::seconds(5), [&] { return count > seen; });
  }
};

/// The folder of a secured domain, as long as this process lives.
std::string secured_folder() {
  static const test::TemporaryFolder parent;
  static const std::filesystem::path folder = parent / "secured";
  static const auto made =
      secure::make_secure_folder(folder, {.validity = secure::ten_years(std::chrono::system_clock::now())});
  return made ? folder.string() : throw std::runtime_error(made.error());
}

enum class Way { kOpen, kSecured, kSharedMemory };

/// While it lives, sessions of Zenoh that begin in this process and its children share memory.
class SharedMemory {
 public:
  SharedMemory() {
    std::ofstream(settings_) << "{transport: {shared_memory: {enabled: true}}}";
    setenv("ZENOH_CONFIG", settings_.c_str(), 1);
  }
  ~SharedMemory() { unsetenv("ZENOH_CONFIG"); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

 private:
  test::TemporaryFolder folder_;
  std::filesystem::path settings_ = folder_ / "settings.json5";
};

void deliver(benchmark::State& state, Vendor writer, Vendor reader, Way way) {
  std::optional<SharedMemory> shared_memory;
  if (way == Way::kSharedMemory) shared_memory.emplace();
  const bus::DomainLock lock;
  const int domain = lock.domain();
  const std::string secured = way == Way::kSecured ? secured_folder() : "";
  const ReaderProcess process(reader, domain, secured);
  Answers answers;
  auto participant = join(writer, domain, secured, "player");
  auto publisher = participant->advertise<Image>(kPicture, kSensor);
  auto subscription = participant->subscribe<Header>(
      kAnswer, kStream, [&](const std::shared_ptr<const Header>& answer) { answers.receive(*answer); });
  Image image;
  image.data().assign(static_cast<std::size_t>(state.range(0)), 5);
  const auto exchange = [&] {
    const std::size_t seen = answers.count;
    image.header().frame_id(std::to_string(now_ns()));
    publisher.write(image);
    return answers.wait_beyond(seen);
  };
  while (publisher.matched() == 0 || subscription.matched() == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  for (int warm_up = 0; warm_up < 10; ++warm_up) exchange();

  std::vector<double> latencies_ms;
  const double writer_cpu = cpu_seconds();
  const double reader_cpu = answers.reader_cpu_s;
  for ([[maybe_unused]] auto _ : state) {
    if (!exchange()) {
      state.SkipWithError("a picture was lost");
      break;
    }
    state.SetIterationTime(answers.latency_s);
    latencies_ms.push_back(1e3 * answers.latency_s);
  }
  if (latencies_ms.empty()) return;
  std::sort(latencies_ms.begin(), latencies_ms.end());
  const auto count = static_cast<double>(latencies_ms.size());
  state.counters["median_ms"] = latencies_ms[latencies_ms.size() / 2];
  state.counters["p99_ms"] = latencies_ms[latencies_ms.size() * 99 / 100];
  state.counters["writer_cpu_ms"] = 1e3 * (cpu_seconds() - writer_cpu) / count;
  state.counters["reader_cpu_ms"] = 1e3 * (answers.reader_cpu_s - reader_cpu) / count;
}

#define RDS_BUS_BENCHMARK(name, writer, reader, way)    \
  BENCHMARK_CAPTURE(deliver, name, writer, reader, way) \
      ->Arg(100)                                        \
      ->Arg(1'500'000)                                  \
      ->Iterations(300)                                 \
      ->UseManualTime()                                 \
      ->Unit(benchmark::kMillisecond)

RDS_BUS_BENCHMARK(fastdds_to_fastdds, Vendor::kFastDds, Vendor::kFastDds, Way::kOpen);
RDS_BUS_BENCHMARK(fastdds_to_cyclonedds, Vendor::kFastDds, Vendor::kCycloneDds, Way::kOpen);
RDS_BUS_BENCHMARK(cyclonedds_to_fastdds, Vendor::kCycloneDds, Vendor::kFastDds, Way::kOpen);
RDS_BUS_BENCHMARK(cyclonedds_to_cyclonedds, Vendor::kCycloneDds, Vendor::kCycloneDds, Way::kOpen);
RDS_BUS_BENCHMARK(zenoh_to_zenoh, Vendor::kZenoh, Vendor::kZenoh, Way::kOpen);
RDS_BUS_BENCHMARK(fastdds_secured, Vendor::kFastDds, Vendor::kFastDds, Way::kSecured);
RDS_BUS_BENCHMARK(cyclonedds_secured, Vendor::kCycloneDds, Vendor::kCycloneDds, Way::kSecured);
RDS_BUS_BENCHMARK(zenoh_secured, Vendor::kZenoh, Vendor::kZenoh, Way::kSecured);
RDS_BUS_BENCHMARK(zenoh_shared_memory, Vendor::kZenoh, Vendor::kZenoh, Way::kSharedMemory);

}  // namespace
}  // namespace rds::bus

int main(int argc, char** argv) {
  if (argc == 5 && std::string(argv[1]) == "reader")
    return rds::bus::run_reader(argv[2], std::stoi(argv[3]), argv[4]);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
