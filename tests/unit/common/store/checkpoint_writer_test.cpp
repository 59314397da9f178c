// SPDX-License-Identifier: Apache-2.0
#include "common/store/checkpoint_writer.hpp"

#include <fstream>
#include <future>
#include <mutex>

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::store {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Batch batch_of(std::uint64_t first, std::uint64_t end, std::size_t size = 100) {
  Batch batch;
  for (std::uint64_t id = first; id < end; ++id)
    batch.put("keyframe", id, Bytes(size, static_cast<std::uint8_t>(id)));
  return batch;
}

class Checkpoints : public ::testing::Test {
 protected:
  [[nodiscard]] Checkpoint opened(std::uint64_t max_bytes = 0) const {
    auto checkpoint = open_checkpoint(file_, max_bytes);
    if (!checkpoint) throw std::runtime_error(checkpoint.error());
    return std::move(*checkpoint);
  }
  [[nodiscard]] std::uint64_t rows() const { return opened().store.rows(); }
  [[nodiscard]] CheckpointWriter::Report reported() {
    return [this](const std::string& failure) { reports_.push_back(failure); };
  }
  static CheckpointWriter::Clock::time_point soon() { return CheckpointWriter::Clock::now() + 30s; }
  void damage(const std::filesystem::path& file) const {
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
    out << std::string(8000, 'x');
  }

  test::TemporaryFolder place_;
  std::filesystem::path file_ = place_ / "checkpoints" / "mapper.db";
  std::vector<std::string> reports_;
  CheckpointWriter::Limits no_copies_{.backup = 0ms};
};

TEST_F(Checkpoints, AreOpenedByOneProcessAtATime) {
  const Checkpoint first = opened();
  const auto second = open_checkpoint(file_);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error(), HasSubstr("another process"));
}

TEST_F(Checkpoints, ADamagedOneIsMovedAsideAndThePreviousOneUsed) {
  {
    Checkpoint checkpoint = opened();
    ASSERT_TRUE(checkpoint.store.apply(batch_of(0, 50, 1000)));
    ASSERT_TRUE(checkpoint.keep_previous());
    ASSERT_TRUE(checkpoint.store.apply(batch_of(50, 60, 1000)));
  }
  damage(file_);
  const Checkpoint again = opened();
  EXPECT_EQ(again.store.rows(), 50U);
  EXPECT_THAT(again.found, ElementsAre(::testing::AllOf(HasSubstr(file_.string()), HasSubstr("previous"))));
  EXPECT_TRUE(std::filesystem::exists(damaged_of(file_)));
  EXPECT_TRUE(std::filesystem::exists(previous_of(file_)));
}

TEST_F(Checkpoints, WithoutAGoodPreviousOneADamagedOneBeginsAnew) {
  { ASSERT_TRUE(opened().store.apply(batch_of(0, 50, 1000))); }
  damage(file_);
  const Checkpoint again = opened();
  EXPECT_EQ(again.store.rows(), 0U);
  EXPECT_THAT(again.found, ElementsAre(HasSubstr("no previous one")));
}

TEST_F(Checkpoints, ForeignFilesStayWhereTheyAre) {
  test::write_text(file_, std::string(5000, 'x'));
  EXPECT_FALSE(open_checkpoint(file_));
  EXPECT_EQ(test::read_text(file_), std::string(5000, 'x'));
}

TEST_F(Checkpoints, AMissingOneIsReplacedByThePreviousOne) {
  {
    Checkpoint checkpoint = opened();
    ASSERT_TRUE(checkpoint.store.apply(batch_of(0, 5)));
    ASSERT_TRUE(checkpoint.keep_previous());
  }
  std::filesystem::remove(file_);
  EXPECT_EQ(rows(), 5U);
}

TEST_F(Checkpoints, AreWrittenBesideAndReadAsTheyWillBe) {
  {
    CheckpointWriter writer(opened(), no_copies_, reported());
    Batch batch = batch_of(0, 10);
    ASSERT_TRUE(writer.write(batch));
    EXPECT_TRUE(batch.empty());
    EXPECT_EQ(writer.get("keyframe", 9), Bytes(100, 9));
    ASSERT_TRUE(writer.flush(soon()));
    EXPECT_EQ(writer.get("keyframe", 9), Bytes(100, 9));
    EXPECT_EQ(writer.get("keyframe", 10), std::nullopt);
    Batch later;
    later.erase("keyframe", 9);
    ASSERT_TRUE(writer.write(later));
    EXPECT_EQ(writer.get("keyframe", 9), std::nullopt);
  }
  EXPECT_EQ(rows(), 9U);
  EXPECT_THAT(reports_, IsEmpty());
}

TEST_F(Checkpoints, SnapshotsAreMadeOnTheWritersThreadFromWhatIsThere) {
  CheckpointWriter writer(opened(), no_copies_, reported());
  Batch batch = batch_of(0, 3);
  ASSERT_TRUE(writer.write(batch));
  std::promise<std::pair<std::uint64_t, std::thread::id>> seen;
  writer.write([&](const Store& written) {
    seen.set_value({written.rows(), std::this_thread::get_id()});
    return batch_of(3, 4);
  });
  ASSERT_TRUE(writer.flush(soon()));
  const auto [rows_seen, thread] = seen.get_future().get();
  EXPECT_EQ(rows_seen, 3U);
  EXPECT_NE(thread, std::this_thread::get_id());
  EXPECT_TRUE(writer.get("keyframe", 3));
}

TEST_F(Checkpoints, AFullDiskIsReportedOnceAndWhatWaitedIsWrittenLater) {
  {
    CheckpointWriter writer(opened(1'000'000), no_copies_, reported());
    Batch batch = batch_of(0, 30, 100'000);
    ASSERT_TRUE(writer.write(batch));
    EXPECT_FALSE(writer.flush(soon()));
    EXPECT_FALSE(writer.flush(soon()));
    EXPECT_GE(writer.log().failed(), 2U);
    EXPECT_EQ(writer.get("keyframe", 29), Bytes(100'000, 29));
    Batch less;
    for (std::uint64_t id = 3; id < 30; ++id) less.erase("keyframe", id);
    ASSERT_TRUE(writer.write(less));
    EXPECT_TRUE(writer.flush(soon()));
  }
  EXPECT_EQ(rows(), 3U);
  EXPECT_THAT(reports_, ElementsAre(HasSubstr("full"), ""));
}

TEST_F(Checkpoints, TooMuchThatWaitsIsRefused) {
  CheckpointWriter writer(opened(100'000), {.max_waiting_bytes = 1'000'000, .backup = 0ms}, reported());
  Batch batch = batch_of(0, 9, 100'000);
  ASSERT_TRUE(writer.write(batch));
  Batch more = batch_of(9, 12, 100'000);
  EXPECT_FALSE(writer.write(more));
  EXPECT_THAT(more.rows(), SizeIs(3));
}

TEST_F(Checkpoints, AStopKeepsWhatWaitsAndMakesItThePreviousOne) {
  {
    CheckpointWriter writer(opened(), {.last_words = 60s}, reported());
    Batch batch = batch_of(0, 40, 10'000);
    ASSERT_TRUE(writer.write(batch));
  }
  EXPECT_EQ(rows(), 40U);
  EXPECT_EQ(Store::open(previous_of(file_))->rows(), 40U);
}

TEST_F(Checkpoints, WhatWasGoodAtTheStartBecomesThePreviousOne) {
  { ASSERT_TRUE(opened().store.apply(batch_of(0, 4))); }
  CheckpointWriter writer(opened(), {}, reported());
  ASSERT_TRUE(writer.flush(soon()));
  EXPECT_EQ(Store::open(previous_of(file_))->rows(), 4U);
}

TEST_F(Checkpoints, TheStateBeforeAChangeIsKeptWhenAsked) {
  CheckpointWriter writer(opened(), {}, reported());
  Batch batch = batch_of(0, 4);
  ASSERT_TRUE(writer.write(batch));
  ASSERT_TRUE(writer.flush(soon()));
  writer.keep_previous();
  Batch anew;
  anew.clear();
  ASSERT_TRUE(writer.write(anew));
  ASSERT_TRUE(writer.flush(soon()));
  EXPECT_EQ(Store::open(previous_of(file_))->rows(), 4U);
  EXPECT_EQ(writer.get("keyframe", 0), std::nullopt);
}

}  // namespace
}  // namespace rds::store
