#include "tests/transport/sinks/driver.hpp"

#include <linux/serial.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <cstdarg>

namespace {
vestige::test::Driver* driver = nullptr;
}

namespace vestige::test {

Driver::Driver() {
  driver = this;
}

Driver::~Driver() {
  driver = nullptr;
}

}  // namespace vestige::test

// The names are the linker's (--wrap).
extern "C" {

int __real_tcsetattr(int descriptor, int when, const termios* settings);
int __wrap_tcsetattr(int descriptor, int when, const termios* settings);
int __real_ioctl(int descriptor, unsigned long request, ...);
int __wrap_ioctl(int descriptor, unsigned long request, ...);

int __wrap_tcsetattr(int descriptor, int when, const termios* settings) {
  termios taken = *settings;
  if (driver != nullptr && driver->only_9600_baud) {
    ::cfsetispeed(&taken, B9600);
    ::cfsetospeed(&taken, B9600);
  }
  return __real_tcsetattr(descriptor, when, &taken);
}

int __wrap_ioctl(int descriptor, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (driver != nullptr && driver->has_serial_flags) {
    auto* settings = static_cast<serial_struct*>(argument);
    if (request == TIOCGSERIAL) {
      settings->flags = driver->serial_flags;
      return 0;
    }
    if (request == TIOCSSERIAL) {
      driver->serial_flags = settings->flags;
      return 0;
    }
  }
  if (driver != nullptr && request == TIOCOUTQ && driver->pending_bytes) {
    *static_cast<int*>(argument) = *driver->pending_bytes;
    return 0;
  }
  return __real_ioctl(descriptor, request, argument);
}
}
