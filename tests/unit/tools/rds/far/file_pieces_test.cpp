// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/far/file_pieces.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::run {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class FilePieces : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& content) {
    std::filesystem::create_directories((folder_ / path).parent_path());
    test::write_text(folder_ / path, content);
  }
  std::string read(const FileEntry& file) {
    std::string content;
    while (content.size() < file.bytes)
      content += parse_piece(read_piece(folder_.path(), piece_request(file, content.size())),
                             std::min<std::size_t>(kPieceBytes, file.bytes - content.size()));
    return content;
  }
  test::TemporaryFolder folder_;
};

TEST_F(FilePieces, AreTheFileAgain) {
  for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, kPieceBytes - 1, kPieceBytes, kPieceBytes + 1,
                                  3 * kPieceBytes + 2}) {
    std::string content;
    for (std::size_t i = 0; i < bytes; ++i) content += static_cast<char>(i * 31 % 256);
    write("log/a file.log", content);
    EXPECT_TRUE(read({"log/a file.log", bytes}) == content) << bytes;
  }
}

TEST_F(FilePieces, ListsRegularFilesBelowAFolder) {
  write("log/a.log", "abc");
  write("log/deep/b.log", "");
  write("c", "not asked for");
  std::filesystem::create_symlink("/etc/passwd", folder_ / "log/link");
  EXPECT_THAT(parse_files(list_files(folder_.path(), "log")),
              UnorderedElementsAre(FileEntry{"log/a.log", 3}, FileEntry{"log/deep/b.log", 0}));
  EXPECT_THAT(parse_files(list_files(folder_.path(), "nothing")), IsEmpty());
  EXPECT_THAT(parse_files(list_files(folder_.path(), "..")), IsEmpty());
}

TEST_F(FilePieces, RefusesWhatIsNotBelowTheFolder) {
  for (const char* request : {"0 ../etc/passwd", "0 /etc/passwd", "0 log/../../x", "0 ", "", "x a", "-1 a", "0 none"})
    EXPECT_THROW(read_piece(folder_.path(), request), std::runtime_error) << request;
  EXPECT_THROW(parse_files(R"([["../x", 1]])"), std::runtime_error);
  EXPECT_THROW(parse_files(R"([["/x", 1]])"), std::runtime_error);
  EXPECT_THROW(parse_files(R"([["x"]])"), std::runtime_error);
  EXPECT_THROW(parse_files("{"), std::runtime_error);
}

TEST_F(FilePieces, RefusesAPieceOfAnotherSize) {
  write("a", "abcdef");
  const std::string piece = read_piece(folder_.path(), "0 a");
  EXPECT_EQ(parse_piece(piece, 6), "abcdef");
  for (const std::size_t bytes : {0UL, 3UL, 7UL, 900UL}) EXPECT_THROW(parse_piece(piece, bytes), std::runtime_error);
  EXPECT_THROW(parse_piece("?!", 2), std::runtime_error);
}

}  // namespace
}  // namespace rds::run
