// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/keyframe/keyframe_bytes.hpp"

#include <algorithm>

#include "common/map_file/geometry_bytes.hpp"

namespace rds::mapper {
namespace {

using map_file::ByteReader;
using map_file::ByteWriter;

constexpr std::uint8_t kWhole = 255;  // a depth as it is follows; else: difference to the last one
constexpr int kMaxSide = 8192;        // sampled pixels

void put_depths(ByteWriter& writer, const std::vector<std::uint16_t>& depths) {
  map_file::Bytes bytes(3 * depths.size());
  std::uint8_t* to = bytes.data();
  std::uint16_t last = 0;
  for (const std::uint16_t depth : depths) {
    const int step = depth - last;
    const int folded = step >= 0 ? 2 * step : -2 * step - 1;
    *to++ = static_cast<std::uint8_t>(std::min<int>(folded, kWhole));
    if (folded >= kWhole) {
      *to++ = static_cast<std::uint8_t>(depth);
      *to++ = static_cast<std::uint8_t>(depth >> 8);
    }
    last = depth;
  }
  writer.put_bytes({bytes.data(), to});
}

void get_depths(ByteReader& reader, std::vector<std::uint16_t>& depths) {
  std::uint16_t last = 0;
  for (auto depth = depths.begin(); depth != depths.end() && reader.ok();) {
    const auto bytes = reader.get_bytes(static_cast<std::size_t>(depths.end() - depth));  // one each at least
    auto byte = bytes.begin();
    const auto next = [&] { return byte != bytes.end() ? *byte++ : reader.get<std::uint8_t>(); };
    while (byte != bytes.end()) {
      const std::uint8_t folded = *byte++;
      if (folded == kWhole) {
        last = next();
        last = static_cast<std::uint16_t>(last | next() << 8);
      } else {
        last = static_cast<std::uint16_t>(last + ((folded & 1) != 0 ? -(folded + 1) / 2 : folded / 2));
      }
      *depth++ = last;
    }
  }
}

/// Length, then (times, value) until the length is reached.
template <class Values>
void put_runs(ByteWriter& writer, const Values& values) {
  writer.put_count(values.size());
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i + 1;
    while (end < values.size() && values[end] == values[i] && end - i < UINT16_MAX) ++end;
    writer.put(static_cast<std::uint16_t>(end - i));
    writer.put(static_cast<std::uint16_t>(values[i]));
    i = end;
  }
}

/// @param size  that the list has if it is not empty.
template <class Values>
void get_runs(ByteReader& reader, std::size_t size, Values& values) {
  using Value = typename Values::value_type;
  const auto count = reader.get<std::uint64_t>();
  if (count != 0 && count != size) reader.refuse("a list that does not fit the picture");
  if (!reader.ok()) return;
  values.reserve(count);
  while (values.size() < count && reader.ok()) {
    const auto times = reader.get<std::uint16_t>();
    const auto value = static_cast<Value>(reader.get<std::uint16_t>());
    if (times == 0 || times > count - values.size()) return reader.refuse("a run that is too long");
    values.insert(values.end(), times, value);
  }
}

void put_cells(ByteWriter& writer, const cv::Mat1b& cells) {
  writer.put(std::int32_t{cells.rows});
  writer.put(std::int32_t{cells.cols});
  for (int row = 0; row < cells.rows; ++row)
    writer.put_bytes({cells.ptr(row), static_cast<std::size_t>(cells.cols)});
}

cv::Mat1b get_cells(ByteReader& reader) {
  const auto rows = reader.get<std::int32_t>();
  const auto columns = reader.get<std::int32_t>();
  if (rows < 0 || rows > kMaxSide || columns < 0 || columns > kMaxSide) reader.refuse("too many cells");
  if (!reader.ok() || rows == 0 || columns == 0) return {};
  const auto bytes = reader.get_bytes(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  if (!reader.ok()) return {};
  cv::Mat1b cells(rows, columns);
  std::ranges::copy(bytes, cells.begin());
  return cells;
}

void put(ByteWriter& writer, const ObjectSighting& sighting) {
  writer.put(sighting.label);
  writer.put(sighting.score);
  writer.put(static_cast<std::uint8_t>(sighting.cut_by_border));
  const geometry::Box2& box = sighting.box_px;
  for (const double value : {box.x0, box.y0, box.x1, box.y1}) writer.put(value);
  writer.put_count(sighting.points_in_camera.size());
  for (const auto& point : sighting.points_in_camera)
    for (int axis = 0; axis < 3; ++axis) writer.put(point[axis]);
}

ObjectSighting get_sighting(ByteReader& reader) {
  ObjectSighting sighting;
  sighting.label = reader.get<std::uint16_t>();
  sighting.score = reader.get<float>();
  sighting.cut_by_border = reader.get<std::uint8_t>() != 0;
  geometry::Box2& box = sighting.box_px;
  for (double* value : {&box.x0, &box.y0, &box.x1, &box.y1}) *value = reader.get<double>();
  sighting.points_in_camera.resize(reader.get_count(3 * sizeof(float)));
  for (auto& point : sighting.points_in_camera)
    for (int axis = 0; axis < 3; ++axis) point[axis] = reader.get<float>();
  return sighting;
}

void get_size(ByteReader& reader, KeyframeRecord& record) {
  for (int* value : {&record.grid.stride, &record.grid.width, &record.grid.height, &record.movable.side_px})
    *value = reader.get<std::int32_t>();
  const auto fits = [](int side) { return side > 0 && side <= kMaxSide; };
  if (!fits(record.grid.width) || !fits(record.grid.height) || record.grid.stride <= 0 ||
      record.movable.side_px < 0)
    reader.refuse("an impossible size");
}

}  // namespace

map_file::Bytes to_bytes(const KeyframeRecord& record) {
  ByteWriter writer;
  writer.put(record.id);
  writer.put(record.stamp_ns);
  map_file::put(writer, record.grid.camera);
  for (const int value : {record.grid.stride, record.grid.width, record.grid.height, record.movable.side_px})
    writer.put(std::int32_t{value});
  put_depths(writer, record.depth_tenth_mm);
  writer.put_bytes(record.rgb);
  put_cells(writer, record.movable.cells);
  put_runs(writer, record.classes);
  put_runs(writer, record.objects.labels);
  writer.put(static_cast<std::uint8_t>(record.objects.looked_for));
  writer.put_count(record.objects.sightings.size());
  for (const auto& sighting : record.objects.sightings) put(writer, sighting);
  map_file::Bytes bytes = writer.take();
  bytes.shrink_to_fit();
  return bytes;
}

tl::expected<KeyframeRecord, std::string> record_from_bytes(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  KeyframeRecord record;
  record.id = reader.get<std::uint64_t>();
  record.stamp_ns = record.time_ns = reader.get<std::int64_t>();
  record.grid.camera = map_file::get_camera(reader);
  get_size(reader, record);
  if (!reader.ok()) return tl::unexpected(reader.finish().error());
  const std::size_t size =
      static_cast<std::size_t>(record.grid.width) * static_cast<std::size_t>(record.grid.height);
  if (size > bytes.size()) return tl::unexpected(std::string("fewer bytes than pixels"));
  record.depth_tenth_mm.resize(size);
  get_depths(reader, record.depth_tenth_mm);
  const auto rgb = reader.get_bytes(3 * size);
  record.rgb.assign(rgb.begin(), rgb.end());
  record.movable.cells = get_cells(reader);
  if (reader.ok() && !spread(record.movable, record.grid))
    reader.refuse("cells that do not cover the picture");
  get_runs(reader, size, record.classes);
  get_runs(reader, size, record.objects.labels);
  record.objects.looked_for = reader.get<std::uint8_t>() != 0;
  record.objects.sightings.resize(reader.get_count(sizeof(std::uint64_t)));
  for (auto& sighting : record.objects.sightings) sighting = get_sighting(reader);
  if (auto read = reader.finish(); !read) return tl::unexpected(read.error());
  return record;
}

}  // namespace rds::mapper
