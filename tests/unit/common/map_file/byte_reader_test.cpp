// SPDX-License-Identifier: Apache-2.0
#include "common/map_file/byte_reader.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "common/map_file/byte_writer.hpp"

namespace rds::map_file {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ByteWriter, IsLittleEndianWithoutPadding) {
  ByteWriter writer;
  writer.put(std::uint8_t{1});
  writer.put(std::uint32_t{0x05040302});
  EXPECT_THAT(writer.bytes(), ElementsAre(1, 2, 3, 4, 5));
}

TEST(ByteReader, ReadsBackWhatWasWritten) {
  ByteWriter writer;
  writer.put(std::int64_t{-7});
  writer.put(0.1);
  writer.put(2.5F);
  writer.put_text("kitchen");
  const Bytes bytes = writer.take();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::int64_t>(), -7);
  EXPECT_EQ(reader.get<double>(), 0.1);
  EXPECT_EQ(reader.get<float>(), 2.5F);
  EXPECT_EQ(reader.get_text(), "kitchen");
  EXPECT_TRUE(reader.finish());
}

TEST(ByteReader, EndsWithZerosAndTheFirstFault) {
  const Bytes bytes{1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0U);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0U) << "bytes before the fault are not read again";
  reader.refuse("a later fault");
  const auto read = reader.finish();
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), HasSubstr("4 bytes expected where 3 are left"));
}

TEST(ByteReader, RefusesAListThatCannotBeThere) {
  ByteWriter writer;
  writer.put(std::numeric_limits<std::uint64_t>::max() / 2);
  writer.put(1.0);
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.get_count(8), 0U);
  EXPECT_FALSE(reader.ok());
}

TEST(ByteReader, RefusesNumbersThatAreNotFinite) {
  ByteWriter writer;
  writer.put(std::numeric_limits<float>::quiet_NaN());
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.get<float>(), 0);
  EXPECT_FALSE(reader.finish());
}

TEST(ByteReader, RefusesBytesThatAreLeftOver) {
  const Bytes bytes{1, 2};
  ByteReader reader(bytes);
  reader.get<std::uint8_t>();
  const auto read = reader.finish();
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error(), HasSubstr("1 bytes too many"));
}

}  // namespace
}  // namespace rds::map_file
