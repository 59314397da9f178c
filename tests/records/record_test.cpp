// SPDX-License-Identifier: Apache-2.0
// `rds record` beside `rds play`: nothing is lost, and whatever happens to it, what it wrote can be read.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_domain.hpp"
#include "tools/recording/bag_recording.hpp"
#include "tools/recording/open_recording.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class Record : public testing::TestWithParam<std::string> {
 protected:
  Record() {
    make_small_dataset(place_ / "data", 30);
    player_ = std::make_unique<Process>(on_bus({rds(), "play", (place_ / "data").string(), "--loop"}));
  }
  [[nodiscard]] std::vector<std::string> on_bus(std::vector<std::string> command) const {
    command.insert(command.end(),
                   {"--loopback", "--domain", std::to_string(test_domain()), "--bus", GetParam()});
    return command;
  }
  [[nodiscard]] std::vector<std::string> recorder(const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{rds(), "record", file().string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return on_bus(std::move(command));
  }
  [[nodiscard]] fs::path file() const { return place_ / "a.mcap"; }

  /// When the last message was recorded that can be read.
  [[nodiscard]] std::int64_t last_time_ns() const {
    std::int64_t last = 0;
    const auto bag = recording::open_bag(file());
    EXPECT_TRUE(bag) << bag.error();
    const auto scan = (*bag)->scan([&](const auto&, const recording::BagMessage& message, const auto&) {
      last = std::max(last, message.log_time_ns);
    });
    EXPECT_TRUE(scan) << scan.error();
    return last;
  }
  /// Until the first messages are in the file.
  void wait_for_messages() const {
    constexpr std::uintmax_t kMoreThanAHeader = 1000;
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    std::error_code error;
    while ((!fs::exists(file(), error) || fs::file_size(file(), error) < kMoreThanAHeader) &&
           std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(5ms);
  }

  TemporaryFolder place_;
  std::unique_ptr<Process> player_;
};
INSTANTIATE_TEST_SUITE_P(Vendors, Record, testing::ValuesIn(all_vendor_names()), given_name);

TEST_P(Record, NothingOfACameraIsLost) {
  const auto result = run_process(recorder({"--camera", "--seconds", "4"}), 30s);
  EXPECT_EQ(result.status, 0) << result.standard_error;
  EXPECT_THAT(result.standard_output, HasSubstr("0 dropped, 0 lost by the bus"));
  const auto opened = recording::open_recording(file());
  ASSERT_TRUE(opened) << opened.error();
  const auto& frames = opened->recording->frames();
  EXPECT_GT(frames.size(), 40U);
  for (std::size_t i = 1; i < frames.size(); ++i)
    EXPECT_LT(frames[i].stamp_ns - frames[i - 1].stamp_ns, 40'000'000) << "a frame is missing before " << i;
  EXPECT_TRUE(opened->recording->load(frames.back()));
}

TEST_P(Record, AKilledOneLeavesAllButItsLastSecond) {
  const int moments = std::getenv("RDS_SOAK") != nullptr ? 50 : 5;
  for (int i = 0; i < moments; ++i) {
    fs::remove(file());
    Process process(recorder({"--camera"}));
    wait_for_messages();
    std::this_thread::sleep_for(std::chrono::milliseconds(200 + 37 * i));
    const std::int64_t killed_ns = now_ns();
    process.kill();
    process.wait(10s);
    const std::int64_t last_ns = last_time_ns();
    EXPECT_GT(last_ns, killed_ns - 1'000'000'000) << "killed at moment " << i;
  }
  const auto recovered = run_process({rds(), "record", "--recover", file().string()}, 30s);
  EXPECT_EQ(recovered.status, 0) << recovered.standard_error;
  EXPECT_THAT(recovered.standard_output, HasSubstr("messages recovered"));
  const auto again = run_process({rds(), "record", "--recover", file().string()}, 30s);
  EXPECT_THAT(again.standard_output, HasSubstr("left as it is"));
}

TEST_P(Record, AnInterruptedOneIsWhole) {
  Process process(recorder({}));
  wait_for_messages();
  process.send(SIGINT);
  EXPECT_EQ(process.wait(20s), 0) << process.standard_error();
  const auto recovered = run_process({rds(), "record", "--recover", file().string()}, 30s);
  EXPECT_THAT(recovered.standard_output, HasSubstr("left as it is"));
}

TEST_P(Record, WhatCannotBeDoneIsSaidInOneSentence) {
  write_text(file(), "mine");
  const auto overwrites = run_process(recorder({}), 30s);
  EXPECT_EQ(overwrites.status, 2);
  EXPECT_THAT(overwrites.standard_error, HasSubstr("--force"));
  EXPECT_EQ(read_text(file()), "mine");
  const auto no_folder = run_process(on_bus({rds(), "record", (place_ / "none" / "a.mcap").string()}), 30s);
  EXPECT_EQ(no_folder.status, 2);
  EXPECT_THAT(no_folder.standard_error, HasSubstr("cannot be written"));
  const auto nobody = run_process(recorder({"nobody/says/this", "--seconds", "1", "--force"}), 30s);
  EXPECT_EQ(nobody.status, 1);
  EXPECT_THAT(nobody.standard_error, HasSubstr("nobody has published"));
  const auto foreign =
      run_process({rds(), "record", "--recover", (place_ / "data" / "rgb.txt").string()}, 30s);
  EXPECT_EQ(foreign.status, 2);
  EXPECT_THAT(foreign.standard_error, HasSubstr("no MCAP file"));
}

}  // namespace
}  // namespace rds::test
