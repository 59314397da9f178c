// SPDX-License-Identifier: Apache-2.0
#include "common/bus/cyclonedds/cyclonedds_type.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include <dds/ddsi/ddsi_keyhash.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_radmin.h>

#include "common/bus/hand_over.hpp"

namespace rds::bus::detail {
namespace {

struct CarriedType : ddsi_sertype {
  const TypeOps* ops_of_message = nullptr;
};

struct Free {
  void operator()(std::uint8_t* bytes) const { std::free(bytes); }
};

/// A message as on the wire: encapsulation header and CDR, padded to four bytes. Cyclone DDS reads it from
/// here.
struct CarriedMessage : ddsi_serdata {
  CarriedMessage(const ddsi_sertype* carried_type, ddsi_serdata_kind message_kind,
                 std::size_t unpadded_size) {
    ddsi_serdata_init(this, carried_type, message_kind);
    hash = carried_type->serdata_basehash;  // topics without key: all messages belong to one instance
    const std::size_t padding = (0 - unpadded_size) & 3U;
    size = unpadded_size + padding;
    bytes.reset(
        static_cast<std::uint8_t*>(std::malloc(size)));  // not cleared: that costs as much as the copy
    if (bytes == nullptr) throw std::bad_alloc();
    std::memset(bytes.get() + unpadded_size, 0, padding);
  }

  std::unique_ptr<std::uint8_t, Free> bytes;
  std::size_t size = 0;
};

/// A look at a message that Cyclone DDS holds.
class Look {
 public:
  explicit Look(const ddsi_serdata* data) : message_(static_cast<const CarriedMessage*>(data)) {}
  ~Look() { tell_read(&message_->refc); }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;
  const CarriedMessage* operator->() const { return message_; }

 private:
  const CarriedMessage* message_;
};

/// What the last holder calls.
void free_message(ddsi_serdata* data) {
  tell_read_by_all(&data->refc);
  delete static_cast<CarriedMessage*>(data);
}

const TypeOps& message_ops(const ddsi_sertype* type) {
  return *static_cast<const CarriedType*>(type)->ops_of_message;
}

/// C++ exceptions must not pass through Cyclone DDS; to it nullptr means that the data could not be made.
template <class Make>
ddsi_serdata* make_or_null(Make make) {
  try {
    return make().release();
  } catch (const std::exception&) {
    return nullptr;
  }
}

constexpr std::size_t kEmptyMessageSize = 4;

std::unique_ptr<CarriedMessage> make_empty(const ddsi_sertype* type) {
  auto message = std::make_unique<CarriedMessage>(type, SDK_KEY, kEmptyMessageSize);
  std::memset(message->bytes.get(), 0, message->size);
  return message;
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  return make_or_null([=] {
    auto message = std::make_unique<CarriedMessage>(type, kind, size);
    std::uint32_t offset = 0;
    for (const nn_rdata* f = fragment; f != nullptr; f = f->nextfrag) {
      if (f->maxp1 <= offset) continue;  // fragments may overlap
      const std::uint8_t* payload = NN_RMSG_PAYLOADOFF(f->rmsg, NN_RDATA_PAYLOAD_OFF(f));
      std::memcpy(message->bytes.get() + offset, payload + (offset - f->min), f->maxp1 - offset);
      offset = f->maxp1;
    }
    return message;
  });
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  return make_or_null([=] {
    auto message = std::make_unique<CarriedMessage>(type, kind, size);
    std::size_t offset = 0;
    for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
      std::memcpy(message->bytes.get() + offset, pieces[i].iov_base, pieces[i].iov_len);
      offset += pieces[i].iov_len;
    }
    return message;
  });
}

ddsi_serdata* from_key_hash(const ddsi_sertype* type, const ddsi_keyhash* /*key_hash*/) {
  return make_or_null([=] { return make_empty(type); });
}

ddsi_serdata* from_message(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* source) {
  return make_or_null([=] {
    if (kind == SDK_KEY) return make_empty(type);
    const TypeOps& ops = message_ops(type);
    const std::size_t size = ops.encoded_size(source);
    auto message = std::make_unique<CarriedMessage>(type, kind, size);
    if (ops.encode(source, message->bytes.get(), size) == 0) message.reset();
    return message;
  });
}

void copy_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* target) {
  std::memcpy(target, Look(data)->bytes.get() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* piece) {
  piece->iov_base = Look(data)->bytes.get() + offset;
  piece->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(data);
}

void return_bytes(ddsi_serdata* data, const ddsrt_iovec_t* /*piece*/) {
  ddsi_serdata_unref(data);
}

bool to_sample(const ddsi_serdata* data, void* sample, void** /*buffer*/, void* /*buffer_end*/) {
  const Look message(data);
  static_cast<Sample*>(sample)->decode(message->bytes.get(), message->size);
  return true;  // the Sample knows if it could not be decoded
}

ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  return make_or_null([=] {
    auto key = make_empty(data->type);
    key->type = nullptr;
    return key;
  });
}

bool untyped_to_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*data*/, void* /*sample*/,
                       void** /*buffer*/, void* /*buffer_end*/) {
  return true;  // a state change without data
}

std::size_t print(const ddsi_sertype* /*type*/, const ddsi_serdata* data, char* text, std::size_t size) {
  const int length = std::snprintf(text, size, "(%zu bytes)", Look(data)->size);
  return length > 0 ? static_cast<std::size_t>(length) : 0;
}

const ddsi_serdata_ops* message_operations() {
  static const ddsi_serdata_ops kOperations = [] {
    ddsi_serdata_ops ops{};  // shared memory stays off, so its operations stay empty
    ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
    ops.get_size = [](const ddsi_serdata* d) { return static_cast<std::uint32_t>(Look(d)->size); };
    ops.from_ser = from_fragments;
    ops.from_ser_iov = from_pieces;
    ops.from_keyhash = from_key_hash;
    ops.from_sample = from_message;
    ops.to_ser = copy_bytes;
    ops.to_ser_ref = lend_bytes;
    ops.to_ser_unref = return_bytes;
    ops.to_sample = to_sample;
    ops.to_untyped = to_untyped;
    ops.untyped_to_sample = untyped_to_sample;
    ops.free = free_message;
    ops.print = print;
    ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* key_hash, bool) {
      std::memset(key_hash->value, 0, sizeof key_hash->value);
    };
    return ops;
  }();
  return &kOperations;
}

const ddsi_sertype_ops* type_operations() {
  static const ddsi_sertype_ops kOperations = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    ops.free = [](ddsi_sertype* t) {
      ddsi_sertype_fini(t);
      delete static_cast<CarriedType*>(t);
    };
    ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
    // Samples are never allocated by Cyclone DDS: readers take messages as bytes.
    ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) { std::abort(); };
    ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
    ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) {
      return &message_ops(a) == &message_ops(b);
    };
    ops.hash = [](const ddsi_sertype* t) {
      return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&message_ops(t)) >> 4U);
    };
    ops.get_serialized_size = [](const ddsi_sertype* t, const void* message) {
      return message_ops(t).encoded_size(message);
    };
    ops.serialize_into = [](const ddsi_sertype* t, const void* message, void* bytes, std::size_t size) {
      return message_ops(t).encode(message, static_cast<std::uint8_t*>(bytes), size) != 0;
    };
    return ops;
  }();
  return &kOperations;
}

}  // namespace

ddsi_sertype* make_cyclonedds_type(const TypeOps& type) {
  auto carried = std::make_unique<CarriedType>();
  ddsi_sertype_init_flags(carried.get(), type.dds_name.c_str(), type_operations(), message_operations(),
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  carried->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  carried->ops_of_message = &type;
  return carried.release();
}

}  // namespace rds::bus::detail
