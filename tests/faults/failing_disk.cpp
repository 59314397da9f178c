// SPDX-License-Identifier: Apache-2.0
// To be loaded before a program (LD_PRELOAD): while the file $FAILING_DISK_ARMED exists, writes of the
// program $FAILING_DISK_PROGRAM to files below a folder of the name $FAILING_DISK_FOLDER fail with the number
// in that file.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

const char* setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The next definition of a function: that of the C library, or of a sanitizer.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_below_folder(int file) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t length = readlink(link.c_str(), path, sizeof(path) - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  const std::string folder = std::string("/") + setting("FAILING_DISK_FOLDER") + "/";
  return std::strstr(path, folder.c_str()) != nullptr;
}

/// @return 0, or the errno with which writing to this file fails now.
int failure_of(int file) {
  static const bool kIsMeant =
      std::strcmp(program_invocation_short_name, setting("FAILING_DISK_PROGRAM")) == 0;
  if (!kIsMeant) return 0;
  const int armed = open(setting("FAILING_DISK_ARMED"), O_RDONLY | O_CLOEXEC);
  if (armed < 0) return 0;
  char text[16] = {};
  const bool is_read = read(armed, text, sizeof(text) - 1) > 0;
  close(armed);
  return is_read && is_below_folder(file) ? std::atoi(text) : 0;
}

template <class Result, class... Arguments>
Result fail_or_call(const char* name, int file, Arguments... arguments) {
  const int before = errno;
  if (const int failure = failure_of(file); failure != 0) {
    errno = failure;
    return -1;
  }
  errno = before;
  return next<Result(int, Arguments...)>(name)(file, arguments...);
}

}  // namespace

extern "C" {
ssize_t write(int file, const void* data, size_t size) {
  return fail_or_call<ssize_t>("write", file, data, size);
}
ssize_t writev(int file, const iovec* parts, int count) {
  return fail_or_call<ssize_t>("writev", file, parts, count);
}
ssize_t pwrite(int file, const void* data, size_t size, off_t at) {
  return fail_or_call<ssize_t>("pwrite", file, data, size, at);
}
ssize_t pwrite64(int file, const void* data, size_t size, off64_t at) {
  return fail_or_call<ssize_t>("pwrite64", file, data, size, at);
}
int ftruncate(int file, off_t size) {
  return fail_or_call<int>("ftruncate", file, size);
}
int ftruncate64(int file, off64_t size) {
  return fail_or_call<int>("ftruncate64", file, size);
}
int fsync(int file) {
  return fail_or_call<int>("fsync", file);
}
int fdatasync(int file) {
  return fail_or_call<int>("fdatasync", file);
}
}
