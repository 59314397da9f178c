// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/allocation_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

thread_local long long live_bytes = 0;
thread_local long long peak_live_bytes = 0;

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  live_bytes += static_cast<long long>(malloc_usable_size(memory));
  peak_live_bytes = std::max(peak_live_bytes, live_bytes);
  return memory;
}

void release(void* memory) noexcept {
  if (memory != nullptr) live_bytes -= static_cast<long long>(malloc_usable_size(memory));
  std::free(memory);  // NOLINT
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(std::malloc(std::max<std::size_t>(size, 1)));  // NOLINT
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(align, (size + align - 1) / align * align));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace rds::fuzz {

AllocationWatch::AllocationWatch() {
  live_bytes = peak_live_bytes = 0;
}

std::size_t AllocationWatch::peak_bytes() const {
  return static_cast<std::size_t>(std::max(0LL, peak_live_bytes));
}

}  // namespace rds::fuzz
