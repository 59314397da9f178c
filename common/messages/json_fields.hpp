// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/messages/fields.hpp"
#include "common/messages/json.hpp"

/// The definitions of to_json() and from_json(); only the generated sources include them and instantiate
/// them.
namespace rds::messages {
namespace detail {

template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <class T, std::size_t N>
inline constexpr bool kIsList<std::array<T, N>> = true;

template <class T>
Json value_to_json(const T& value) {
  if constexpr (std::is_same_v<T, char>) {
    return static_cast<unsigned char>(value);  // ROS 2's char is an unsigned number
  } else if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value) ? Json(value) : Json();
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (kIsList<T>) {
    Json list = Json::array();
    for (const auto& element : value) list.push_back(value_to_json(element));
    return list;
  } else {
    Json object = Json::object();
    Fields<T>::visit(
        value, [&object](const char* name, const auto& member) { object[name] = value_to_json(member); });
    return object;
  }
}

[[noreturn]] inline void fail(const std::string& path, const std::string& what) {
  throw std::invalid_argument(path + ": " + what);
}

template <class T>
void integer_from_json(const Json& json, T& value, const std::string& path) {
  using Number = std::conditional_t<std::is_same_v<T, char>, unsigned char, T>;
  if (!json.is_number_integer()) fail(path, "expected an integer, got " + to_text(json));
  const bool fits = json.is_number_unsigned() ? std::in_range<Number>(json.get<std::uint64_t>())
                                              : std::in_range<Number>(json.get<std::int64_t>());
  if (!fits) fail(path, to_text(json) + " is out of range");
  value = static_cast<T>(json.get<Number>());
}

template <class T>
void value_from_json(const Json& json, T& value, const std::string& path);

template <class T>
void list_from_json(const Json& json, T& list, const std::string& path) {
  if (!json.is_array()) fail(path, "expected an array");
  if constexpr (requires { list.resize(json.size()); }) list.resize(json.size());
  if (json.size() != list.size()) fail(path, "expected " + std::to_string(list.size()) + " elements");
  for (std::size_t i = 0; i < list.size(); ++i) {
    typename T::value_type element{};  // std::vector<bool> has no references
    value_from_json(json[i], element, path + "[" + std::to_string(i) + "]");
    list[i] = std::move(element);
  }
}

template <class T>
void struct_from_json(const Json& json, T& message, const std::string& path) {
  if (!json.is_object()) fail(path, "expected an object");
  Fields<T>::visit(message, [&](const char* name, auto& member) {
    const auto found = json.find(name);
    if (found != json.end()) value_from_json(*found, member, path.empty() ? name : path + "." + name);
  });
}

template <class T>
void value_from_json(const Json& json, T& value, const std::string& path) {
  if constexpr (std::is_same_v<T, bool>) {
    if (!json.is_boolean()) fail(path, "expected true or false");
    value = json.get<bool>();
  } else if constexpr (std::is_floating_point_v<T>) {
    if (!json.is_number() && !json.is_null()) fail(path, "expected a number");
    value = json.is_null() ? std::numeric_limits<T>::quiet_NaN() : json.get<T>();
  } else if constexpr (std::is_integral_v<T>) {
    integer_from_json(json, value, path);
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (!json.is_string()) fail(path, "expected a string");
    value = json.get<std::string>();
  } else if constexpr (kIsList<T>) {
    list_from_json(json, value, path);
  } else {
    struct_from_json(json, value, path);
  }
}

}  // namespace detail

template <class Message>
Json to_json(const Message& message) {
  return detail::value_to_json(message);
}

template <class Message>
tl::expected<void, std::string> from_json(const Json& json, Message& message) {
  try {
    detail::struct_from_json(json, message, "");
    return {};
  } catch (const std::invalid_argument& error) {
    return tl::make_unexpected(std::string(error.what()));
  }
}

}  // namespace rds::messages
