// SPDX-License-Identifier: Apache-2.0
// ros_messages FOLDER: FOLDER/TYPE is a message of rds_msgs as it came, FOLDER/TYPE.OTHER the same as
// somebody else wrote it. Reads each with the C++ types that ROS 2's generators make, and says whether what these
// write then is FOLDER/TYPE, byte for byte. Built by rds_msgs_package.py, which makes headers.inc, and
// messages.inc: MESSAGE(TYPE) for each type.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <fastcdr/Cdr.h>

#include "headers.inc"

namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
namespace cdr = rds_msgs::msg::typesupport_fastrtps_cpp;

std::vector<char> bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The message again, with zeros in all gaps; its end may be padded.
template <class Message>
std::vector<char> again(std::vector<char> bytes) {
  FastBuffer given(bytes.data(), bytes.size());
  Cdr reader(given, Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::CdrVersion::XCDRv1);
  reader.read_encapsulation();
  Message message;
  cdr::cdr_deserialize(reader, message);
  std::vector<char> made(2 * bytes.size() + 64);
  FastBuffer room(made.data(), made.size());
  Cdr writer(room, Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::CdrVersion::XCDRv1);
  writer.set_encoding_flag(eprosima::fastcdr::EncodingAlgorithmFlag::PLAIN_CDR);
  writer.serialize_encapsulation();
  cdr::cdr_serialize(message, writer);
  made.resize(writer.get_serialized_data_length());
  return made;
}

template <class Message>
bool is_same(const std::filesystem::path& file) {
  constexpr std::size_t kMostPadding = 3;
  const std::vector<char> came = bytes_of(file.parent_path() / file.stem());
  const std::vector<char> made = again<Message>(bytes_of(file));
  return made.size() <= came.size() && came.size() - made.size() <= kMostPadding &&
         std::equal(made.begin(), made.end(), came.begin());
}

bool is_same(const std::string& type, const std::filesystem::path& file) {
#define MESSAGE(TYPE) \
  if (type == #TYPE) return is_same<rds_msgs::msg::TYPE>(file);
#include "messages.inc"
#undef MESSAGE
  return false;
}

}  // namespace

int main(int, char** arguments) {
  for (const auto& entry : std::filesystem::directory_iterator(arguments[1])) {
    const std::filesystem::path& file = entry.path();
    std::cout << file.filename().string() << ' ' << is_same(file.stem().string(), file) << '\n';
  }
}
