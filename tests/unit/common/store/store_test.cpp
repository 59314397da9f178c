// SPDX-License-Identifier: Apache-2.0
#include "common/store/store.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <sqlite3.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::store {
namespace {

using ::testing::HasSubstr;

Bytes bytes(std::size_t size, std::uint8_t value) {
  return Bytes(size, value);
}

Batch batch_of(std::uint64_t first, std::uint64_t end, std::size_t size = 100) {
  Batch batch;
  for (std::uint64_t id = first; id < end; ++id)
    batch.put("keyframe", id, bytes(size, static_cast<std::uint8_t>(id)));
  return batch;
}

class StoreFile : public ::testing::Test {
 protected:
  [[nodiscard]] Store opened() const {
    auto store = Store::open(file_);
    if (!store) throw std::runtime_error(store.error().sentence);
    return std::move(*store);
  }
  [[nodiscard]] Fault fault() const {
    const auto store = Store::open(file_);
    return store ? Fault{Fault::Kind::kUnavailable, "none"} : store.error();
  }
  void run_sql(const std::string& sql) const {
    const auto connection = Connection::open(file_.string());
    ASSERT_TRUE(connection && connection->run(sql)) << sql;
  }
  test::TemporaryFolder place_;
  std::filesystem::path file_ = place_ / "map.db";
};

TEST_F(StoreFile, GivesBackWhatWasPutWhenOpenedAgain) {
  {
    Store store = opened();
    Batch batch = batch_of(3, 8, 100'000);
    batch.put("meta", 0, {});
    ASSERT_TRUE(store.apply(batch));
  }
  const Store store = opened();
  EXPECT_EQ(store.rows(), 6U);
  EXPECT_EQ(store.get("keyframe", 7).value(), bytes(100'000, 7));
  EXPECT_EQ(store.get("meta", 0).value(), Bytes{});
  EXPECT_EQ(store.get("keyframe", 8).value(), std::nullopt);
  EXPECT_EQ(store.get("meta", 7).value(), std::nullopt);
}

TEST_F(StoreFile, ReplacesErasesAndClears) {
  Store store = opened();
  ASSERT_TRUE(store.apply(batch_of(0, 10)));
  Batch changes;
  changes.put("keyframe", 4, bytes(5, 99));
  changes.erase("keyframe", 5);
  changes.erase("keyframe", 77);
  ASSERT_TRUE(store.apply(changes));
  std::vector<std::uint64_t> ids;
  ASSERT_TRUE(store.for_each("keyframe", [&](std::uint64_t id, auto) { ids.push_back(id); }));
  EXPECT_THAT(ids, ::testing::ElementsAre(0, 1, 2, 3, 4, 6, 7, 8, 9));
  EXPECT_EQ(store.get("keyframe", 4).value(), bytes(5, 99));
  Batch anew;
  anew.clear();
  anew.put("keyframe", 100, bytes(1, 1));
  ASSERT_TRUE(store.apply(anew));
  EXPECT_EQ(store.rows(), 1U);
}

TEST_F(StoreFile, DoesNotWriteAgainWhatIsThereAlready) {
  Store store = opened();
  ASSERT_TRUE(store.apply(batch_of(0, 50, 100'000)));
  const auto journal = std::filesystem::path(file_.string() + "-wal");
  const auto before = std::filesystem::file_size(journal);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(store.apply(batch_of(0, 50, 100'000)));
  EXPECT_LT(std::filesystem::file_size(journal), before + 1'000'000);
}

TEST_F(StoreFile, UsesFreedSpaceAgain) {
  Store store = opened();
  std::uintmax_t half_way = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    Batch batch = batch_of(i, i + 1, 300'000);
    if (i >= 5) batch.erase("keyframe", i - 5);
    ASSERT_TRUE(store.apply(batch));
    if (i == 30) half_way = std::filesystem::file_size(file_);
  }
  EXPECT_LE(std::filesystem::file_size(file_), half_way);
}

TEST_F(StoreFile, ADiskThatIsFullLeavesItAsItWas) {
  auto store = Store::open(file_, 1'000'000);
  ASSERT_TRUE(store);
  ASSERT_TRUE(store->apply(batch_of(0, 3, 100'000)));
  const auto full = store->apply(batch_of(2, 50, 100'001));
  ASSERT_FALSE(full);
  EXPECT_THAT(full.error(), ::testing::AllOf(HasSubstr(file_.string()), HasSubstr("full")));
  EXPECT_EQ(store->rows(), 3U);
  EXPECT_EQ(store->get("keyframe", 2).value(), bytes(100'000, 2));
  EXPECT_TRUE(store->apply(batch_of(10, 12, 100'000)));
}

TEST_F(StoreFile, IsOpenedByOneAtATime) {
  const Store store = opened();
  const Fault second = fault();
  EXPECT_EQ(second.kind, Fault::Kind::kUnavailable);
  EXPECT_THAT(second.sentence, HasSubstr("locked"));
}

TEST_F(StoreFile, FilesOfOthersAreRefusedAndLeftAlone) {
  std::ofstream(file_) << "a diary, not a database, and longer than the header of one is: "
                       << std::string(200, 'x');
  EXPECT_EQ(fault().kind, Fault::Kind::kForeign);
  EXPECT_THAT(test::read_text(file_), HasSubstr("a diary"));
  std::filesystem::remove(file_);
  run_sql("CREATE TABLE addresses (name TEXT);");
  EXPECT_THAT(fault().sentence, ::testing::AllOf(HasSubstr(file_.string()), HasSubstr("another program")));
}

TEST_F(StoreFile, NewerOnesAreRefused) {
  { const Store store = opened(); }
  run_sql("PRAGMA user_version = 7;");
  EXPECT_EQ(fault().kind, Fault::Kind::kNewer);
  EXPECT_THAT(fault().sentence, HasSubstr("format version 7"));
}

TEST_F(StoreFile, LinksFoldersAndPipesAreNotOpened) {
  { const Store store = opened(); }
  std::filesystem::rename(file_, place_ / "elsewhere.db");
  std::filesystem::create_symlink(place_ / "elsewhere.db", file_);
  EXPECT_THAT(fault().sentence, HasSubstr("no regular file"));
  std::filesystem::remove(file_);
  std::filesystem::create_directory(file_);
  EXPECT_THAT(fault().sentence, HasSubstr("no regular file"));
}

TEST_F(StoreFile, ReadsFilesWithoutRowIds) {
  { ASSERT_TRUE(opened().apply(batch_of(0, 5))); }
  run_sql(
      "ALTER TABLE rows RENAME TO new;"
      "CREATE TABLE rows (kind TEXT NOT NULL, id INTEGER NOT NULL, checksum INTEGER NOT NULL,"
      " bytes BLOB NOT NULL,"
      " PRIMARY KEY (kind, id)) WITHOUT ROWID;"
      "INSERT INTO rows SELECT * FROM new; DROP TABLE new;");
  Store store = opened();
  EXPECT_EQ(store.get("keyframe", 3).value(), bytes(100, 3));
  EXPECT_TRUE(store.apply(batch_of(4, 9)));
  EXPECT_EQ(store.rows(), 9U);
}

TEST_F(StoreFile, NoticesAnIndexThatDoesNotFitItsRows) {
  { ASSERT_TRUE(opened().apply(batch_of(0, 5))); }
  std::string file = test::read_text(file_);
  constexpr std::size_t kPage = 4096;
  constexpr char kIndexLeaf = 10;
  for (std::size_t page = 0; page < file.size(); page += kPage)
    if (file[page] == kIndexLeaf) file[file.find("keyframe", page)] = 'K';
  std::ofstream(file_, std::ios::binary) << file;
  EXPECT_EQ(fault().kind, Fault::Kind::kDamaged);
}

TEST_F(StoreFile, NoticesRowsThatAreMissingOrOther) {
  { ASSERT_TRUE(opened().apply(batch_of(0, 5))); }
  run_sql("DELETE FROM rows WHERE id = 2;");
  EXPECT_EQ(fault().kind, Fault::Kind::kDamaged);
  EXPECT_THAT(fault().sentence, HasSubstr("4 rows of 5"));
}

TEST_F(StoreFile, NoticesAKeyOfAnotherType) {
  { ASSERT_TRUE(opened().apply(batch_of(0, 5))); }
  run_sql("UPDATE rows SET kind = CAST(kind AS BLOB) WHERE id = 2;");  // the same bytes, never found again
  EXPECT_EQ(fault().kind, Fault::Kind::kDamaged);
}

TEST_F(StoreFile, IsCopiedWithAllRows) {
  Store store = opened();
  ASSERT_TRUE(store.apply(batch_of(0, 20, 50'000)));
  ASSERT_TRUE(store.copy_to(place_ / "copy.db"));
  ASSERT_TRUE(store.apply(batch_of(20, 21)));
  const auto copy = Store::open(place_ / "copy.db");
  ASSERT_TRUE(copy) << copy.error().sentence;
  EXPECT_EQ(copy->rows(), 20U);
  EXPECT_EQ(copy->get("keyframe", 19).value(), bytes(50'000, 19));
}

TEST_F(StoreFile, ACopyInAFolderThatIsGoneIsMadeNowhere) {
  const Store store = opened();
  EXPECT_FALSE(store.copy_to(place_ / "gone" / "copy.db"));
  EXPECT_FALSE(std::filesystem::exists("copy.db"));
}

TEST_F(StoreFile, ACopyThatIsGivenUpLeavesTheOneBefore) {
  Store store = opened();
  ASSERT_TRUE(store.apply(batch_of(0, 2)));
  ASSERT_TRUE(store.copy_to(place_ / "copy.db"));
  ASSERT_TRUE(store.apply(batch_of(2, 20)));
  EXPECT_FALSE(store.copy_to(place_ / "copy.db", [] { return false; }));
  EXPECT_EQ(Store::open(place_ / "copy.db")->rows(), 2U);
  EXPECT_FALSE(std::filesystem::exists(place_ / "copy.db.partial"));
}

TEST(NamelessStore, LeavesNoFileAndUsesSpaceAgain) {
  const test::TemporaryFolder place;
  auto store = Store::nameless(place.path());
  ASSERT_TRUE(store) << store.error().sentence;
  for (std::uint64_t i = 0; i < 30; ++i) {
    Batch batch = batch_of(i, i + 1, 300'000);
    if (i >= 2) batch.erase("keyframe", i - 2);
    ASSERT_TRUE(store->apply(batch));
  }
  EXPECT_EQ(store->get("keyframe", 29).value(), bytes(300'000, 29));
  EXPECT_TRUE(std::filesystem::is_empty(place.path()));
}

TEST(NamelessStore, SaysWhereItCannotBe) {
  const auto store = Store::nameless("/nowhere/at/all");
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().sentence, HasSubstr("/nowhere/at/all"));
}

TEST(Batch, LaterChangesCountAndAClearTakesAll) {
  Batch batch;
  batch.put("a", 1, bytes(10, 1));
  Batch later;
  later.put("a", 1, bytes(4, 2));
  later.erase("a", 2);
  batch.add(std::move(later));
  EXPECT_EQ(batch.bytes(), 4U);
  EXPECT_EQ(*batch.find({"a", 1}), bytes(4, 2));
  EXPECT_EQ(*batch.find({"a", 2}), std::nullopt);
  EXPECT_EQ(batch.find({"a", 3}), nullptr);
  Batch anew;
  anew.clear();
  batch.add(std::move(anew));
  EXPECT_EQ(*batch.find({"a", 1}), std::nullopt);
  EXPECT_EQ(batch.bytes(), 0U);
}

}  // namespace
}  // namespace rds::store
