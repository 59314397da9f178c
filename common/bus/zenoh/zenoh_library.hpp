// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "common/bus/zenoh/rds_zenoh.h"

namespace rds::bus::detail {

/// The functions of librds_zenoh.so, loaded with the first call from ../lib beside this program's folder: who
/// uses DDS alone pays nothing for it.
///
/// @throws BusError if it is not there, or is of another build.
const RdsZenohApi& zenoh_library();

/// Gives back what one of its functions made.
template <auto member>
struct GiveBack {
  template <class T>
  void operator()(T* object) const {
    (zenoh_library().*member)(object);
  }
};

using ZenohBuffer = std::unique_ptr<RdsZenohBuffer, GiveBack<&RdsZenohApi::free_buffer>>;
using ZenohPublisher = std::unique_ptr<RdsZenohPublisher, GiveBack<&RdsZenohApi::undeclare_publisher>>;
using ZenohQuery = std::unique_ptr<RdsZenohQuery, GiveBack<&RdsZenohApi::free_query>>;
using ZenohQueryable = std::unique_ptr<RdsZenohQueryable, GiveBack<&RdsZenohApi::undeclare_queryable>>;
using ZenohSample = std::unique_ptr<RdsZenohSample, GiveBack<&RdsZenohApi::free_sample>>;
using ZenohSession = std::unique_ptr<RdsZenohSession, GiveBack<&RdsZenohApi::close>>;
using ZenohSubscriber = std::unique_ptr<RdsZenohSubscriber, GiveBack<&RdsZenohApi::undeclare_subscriber>>;
using ZenohToken = std::unique_ptr<RdsZenohToken, GiveBack<&RdsZenohApi::undeclare_token>>;
using ZenohWatch = std::unique_ptr<RdsZenohWatch, GiveBack<&RdsZenohApi::undeclare_watch>>;

/// The file of settings that the user lays over ours; null: none.
const char* users_settings();

// @throws BusError, which names what was to be declared.
ZenohSession open_zenoh(const std::string& settings, const char* over);
ZenohPublisher declare_publisher(const ZenohSession& session, const std::string& key,
                                 const RdsZenohPublisherOptions& options);
ZenohToken declare_token(const ZenohSession& session, const std::string& key);

/// Subscribes; `callback` gets `object`, which lives until no callback can come any more.
template <class Object>
ZenohSubscriber declare_subscriber(const ZenohSession& session, const std::string& key,
                                   const RdsZenohSubscriberOptions& options, RdsZenohOnSample callback,
                                   std::shared_ptr<Object> object);
/// As above, for requests.
template <class Object>
ZenohQueryable declare_queryable(const ZenohSession& session, const std::string& key,
                                 RdsZenohOnQuery callback, std::shared_ptr<Object> object);
/// As above, for tokens.
template <class Object>
ZenohWatch declare_watch(const ZenohSession& session, const std::string& key, RdsZenohOnToken callback,
                         std::shared_ptr<Object> object);

/// The text of a failed call.
class ZenohFailure {
 public:
  char* text() { return text_; }
  static constexpr std::size_t kCapacity = 512;
  /// @throws BusError "Zenoh refused <what>: <text>"
  template <class T>
  T* check(T* object, const std::string& what) const {
    if (object == nullptr) refuse(what);
    return object;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const;
  char text_[kCapacity] = "";
};

template <class Object>
void release_object(void* object) {
  delete static_cast<std::shared_ptr<Object>*>(object);
}

template <class Object>
ZenohSubscriber declare_subscriber(const ZenohSession& session, const std::string& key,
                                   const RdsZenohSubscriberOptions& options, RdsZenohOnSample callback,
                                   std::shared_ptr<Object> object) {
  ZenohFailure failure;
  auto held = std::make_unique<std::shared_ptr<Object>>(std::move(object));
  return ZenohSubscriber(failure.check(
      zenoh_library().declare_subscriber(session.get(), key.c_str(), &options, callback, held.release(),
                                         &release_object<Object>, failure.text(), ZenohFailure::kCapacity),
      "a subscriber on " + key));
}

template <class Object>
ZenohQueryable declare_queryable(const ZenohSession& session, const std::string& key,
                                 RdsZenohOnQuery callback, std::shared_ptr<Object> object) {
  ZenohFailure failure;
  auto held = std::make_unique<std::shared_ptr<Object>>(std::move(object));
  return ZenohQueryable(failure.check(
      zenoh_library().declare_queryable(session.get(), key.c_str(), callback, held.release(),
                                        &release_object<Object>, failure.text(), ZenohFailure::kCapacity),
      "a service at " + key));
}

template <class Object>
ZenohWatch declare_watch(const ZenohSession& session, const std::string& key, RdsZenohOnToken callback,
                         std::shared_ptr<Object> object) {
  ZenohFailure failure;
  auto held = std::make_unique<std::shared_ptr<Object>>(std::move(object));
  return ZenohWatch(failure.check(
      zenoh_library().declare_watch(session.get(), key.c_str(), callback, held.release(),
                                    &release_object<Object>, failure.text(), ZenohFailure::kCapacity),
      "the tokens of " + key));
}

}  // namespace rds::bus::detail
