// SPDX-License-Identifier: Apache-2.0
// A checkpoint whose writer is killed at any moment, or of which any byte is another one.
#include <cstdlib>
#include <random>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/store/checkpoint_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::store {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

bool is_soak() {
  return std::getenv("RDS_SOAK") != nullptr;
}

Bytes content_of(std::uint64_t id) {
  Bytes bytes(1000 + 100 * (id % 50));
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(id + i);
  return bytes;
}

Bytes number(std::uint64_t n) {
  map_file::ByteWriter writer;
  writer.put(n);
  return writer.take();
}

/// Keyframes from `first` on, and how many there are; together or not at all.
Batch batch_of(std::uint64_t first, std::uint64_t end) {
  Batch batch;
  for (std::uint64_t id = first; id < end; ++id) batch.put("keyframe", id, content_of(id));
  batch.put("keyframes", 0, number(end));
  return batch;
}

/// The keyframes of a store, all as they were written; nullopt if one is missing or another.
std::optional<std::uint64_t> keyframes_in(const Store& store) {
  const auto told = store.get("keyframes", 0);
  if (!told) return std::nullopt;
  std::uint64_t keyframes = 0;
  bool right = true;
  const auto read = store.for_each("keyframe", [&](std::uint64_t id, std::span<const std::uint8_t> bytes) {
    right = right && id == keyframes && std::ranges::equal(bytes, content_of(id));
    ++keyframes;
  });
  const Bytes expected = *told ? **told : number(0);
  return read && right && number(keyframes) == expected ? std::optional(keyframes) : std::nullopt;
}

/// In a child: writes checkpoint after checkpoint, until it is killed.
[[noreturn]] void write_for_ever(const fs::path& file) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  auto checkpoint = open_checkpoint(file);
  if (!checkpoint) ::_exit(1);
  std::uint64_t next = keyframes_in(checkpoint->store).value_or(0);
  CheckpointWriter writer(std::move(*checkpoint), {.backup = 5ms}, [](const std::string&) { ::_exit(2); });
  while (true) {
    Batch batch = batch_of(next, next + 3);
    if (next >= 60) batch.clear();  // a new epoch
    if (next >= 60) batch.add(batch_of(0, 3));
    next = next >= 60 ? 3 : next + 3;
    if (!writer.write(batch) || !writer.flush(CheckpointWriter::Clock::now() + 60s)) ::_exit(3);
  }
}

TEST(CheckpointFaults, AWriterThatIsKilledLeavesAWholeCheckpoint) {
  const test::TemporaryFolder place;
  const fs::path file = place / "map.db";
  std::mt19937 random(1);
  const int moments = is_soak() ? 1000 : 200;
  int with_keyframes = 0;
  for (int moment = 0; moment < moments; ++moment) {
    const pid_t child = ::fork();
    if (child == 0) write_for_ever(file);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 60'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer gave up by itself: " << WEXITSTATUS(status);
    const auto checkpoint = open_checkpoint(file);
    ASSERT_TRUE(checkpoint) << checkpoint.error();
    ASSERT_THAT(checkpoint->found, ::testing::IsEmpty());
    const auto keyframes = keyframes_in(checkpoint->store);
    ASSERT_TRUE(keyframes) << "moment " << moment;
    with_keyframes += *keyframes > 0 ? 1 : 0;
  }
  EXPECT_GT(with_keyframes, moments / 2);
}

class FlippedByte : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kPrevious = 2;

  /// A previous store, and a store with a journal that is not in it yet, as after a kill.
  void SetUp() override {
    auto checkpoint = open_checkpoint(made_ / "map.db");
    ASSERT_TRUE(checkpoint);
    ASSERT_TRUE(checkpoint->store.apply(batch_of(0, kPrevious)));
    ASSERT_TRUE(checkpoint->keep_previous());
    ASSERT_TRUE(checkpoint->store.apply(batch_of(kPrevious, kPrevious + 1)));
    ASSERT_TRUE(checkpoint->store.apply(batch_of(kPrevious + 1, kPrevious + 2)));
    for (const auto& entry : fs::directory_iterator(made_.path()))
      if (entry.path().extension() != ".lock")
        files_[entry.path().filename()] = test::read_text(entry.path());
    ASSERT_TRUE(files_.contains("map.db-wal"));
  }

  /// As after a clean stop: everything is in the store.
  void stop_cleanly() {
    { ASSERT_TRUE(open_checkpoint(made_ / "map.db")); }
    files_["map.db"] = test::read_text(made_ / "map.db");
    files_.erase("map.db-wal");
  }

  /// Whatever byte it is: a whole checkpoint is used, and where it is not the newest the log says so.
  void expect_good_with(const std::string& file, std::size_t byte) {
    const test::TemporaryFolder place;
    for (const auto& [name, text] : files_) test::write_text(place / name, text);
    std::string text = files_[file];
    text[byte] = static_cast<char>(text[byte] ^ (1 << (byte % 8)));
    test::write_text(place / file, text);
    const auto checkpoint = open_checkpoint(place / "map.db");
    ASSERT_TRUE(checkpoint) << file << " byte " << byte << ": " << checkpoint.error();
    const auto keyframes = keyframes_in(checkpoint->store);
    ASSERT_TRUE(keyframes) << file << " byte " << byte;
    ASSERT_GE(*keyframes, kPrevious) << file << " byte " << byte;
    ++outcomes_[*keyframes];
    EXPECT_TRUE(checkpoint->found.empty() || *keyframes == kPrevious) << file << " byte " << byte;
    EXPECT_TRUE(file != "map.previous.db" || *keyframes == kPrevious + 2) << "byte " << byte;
  }

  void flip_all(const std::string& file) {
    const std::size_t step = is_soak() ? 1 : 23;
    for (std::size_t byte = 0; byte < files_[file].size() && !HasFatalFailure(); byte += step)
      expect_good_with(file, byte);
  }

  test::TemporaryFolder made_;
  std::map<std::string, std::string> files_;
  std::map<std::uint64_t, int> outcomes_;
};

TEST_F(FlippedByte, InTheStoreIsNoticedOrHarmless) {
  stop_cleanly();
  flip_all("map.db");
  EXPECT_GT(outcomes_[kPrevious + 2], 0);
  EXPECT_GT(outcomes_[kPrevious], 0);
}

TEST_F(FlippedByte, InAStoreWithAJournalIsNoticedOrHarmless) {
  flip_all("map.db");
  EXPECT_GT(outcomes_[kPrevious + 2], 0);
}

TEST_F(FlippedByte, InTheJournalLosesWhatCameLastAtMost) {
  flip_all("map.db-wal");
  EXPECT_GT(outcomes_[kPrevious + 1] + outcomes_[kPrevious], 0);
}

TEST_F(FlippedByte, InThePreviousStoreChangesNothing) {
  flip_all("map.previous.db");
}

}  // namespace
}  // namespace rds::store
