#include "transport/sinks/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "traces/base/descriptor.hpp"
#include "transport/actuator_sink.hpp"
#include "transport/sinks/serial_errors.hpp"

namespace vestige {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

struct Speed {
  std::uint32_t baud;
  speed_t constant;
};

constexpr std::array<Speed, 30> kSpeeds{
    {{50, B50},           {75, B75},           {110, B110},         {134, B134},         {150, B150},
     {200, B200},         {300, B300},         {600, B600},         {1200, B1200},       {1800, B1800},
     {2400, B2400},       {4800, B4800},       {9600, B9600},       {19200, B19200},     {38400, B38400},
     {57600, B57600},     {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
     {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000},
     {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000}, {3500000, B3500000}, {4000000, B4000000}}};

speed_t speed_constant(std::uint32_t baud) {
  for (const Speed& speed : kSpeeds)
    if (speed.baud == baud) return speed.constant;
  std::vector<std::uint32_t> bauds;
  bauds.reserve(kSpeeds.size());
  for (const Speed& speed : kSpeeds) bauds.push_back(speed.baud);
  throw UsageError("--baud", fmt::format("{} is not a standard rate", baud),
                   fmt::format("use the rate that the board is set to, one of {}", fmt::join(bauds, ", ")));
}

void set_raw(const std::string& path, int descriptor, std::uint32_t baud, speed_t speed) {
  const auto refuse = [&] {
    return Error(path, fmt::format("its driver refuses {} baud, 8 data bits, no parity", baud),
                 "use a slower --baud, and set the board to the same rate");
  };
  termios wanted{};
  if (::tcgetattr(descriptor, &wanted) != 0) throw serial_open_error(path, errno);
  ::cfmakeraw(&wanted);
  wanted.c_iflag &= static_cast<tcflag_t>(~(IXON | IXOFF | IXANY | INPCK));
  wanted.c_cflag &= static_cast<tcflag_t>(~(CSTOPB | CRTSCTS | HUPCL));
  wanted.c_cflag |= CREAD | CLOCAL;
  // With a minimum of 0, a line without new bytes would look like a lost one.
  wanted.c_cc[VMIN] = 1;
  wanted.c_cc[VTIME] = 0;
  if (::cfsetispeed(&wanted, speed) != 0 || ::cfsetospeed(&wanted, speed) != 0) throw refuse();
  if (::tcsetattr(descriptor, TCSANOW, &wanted) != 0) throw refuse();
  // tcsetattr succeeds even if it applied only a part.
  termios taken{};
  constexpr tcflag_t kShape = CSIZE | PARENB | CSTOPB | CRTSCTS;
  if (::tcgetattr(descriptor, &taken) != 0 || ::cfgetospeed(&taken) != speed ||
      (taken.c_cflag & kShape) != (wanted.c_cflag & kShape))
    throw refuse();
}

/// FTDI's converters otherwise hold received bytes for 16 ms. Drivers without this setting refuse it, and do not need
/// it.
void ask_for_low_latency(int descriptor) {
  serial_struct settings{};
  if (::ioctl(descriptor, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
  static_cast<void>(::ioctl(descriptor, TIOCSSERIAL, &settings));
}

int open_port(const std::string& path, std::uint32_t baud) {
  const speed_t speed = speed_constant(baud);
  // Checked first, because merely opening some files has side effects.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw serial_open_error(path, errno);
  if (!S_ISCHR(status.st_mode)) throw not_serial_error(path);
  Descriptor port(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (port.value() < 0) throw serial_open_error(path, errno);
  if (::isatty(port.value()) == 0) throw errno == ENOTTY ? not_serial_error(path) : serial_open_error(path, errno);
  // flock keeps out this program and root, TIOCEXCL all others.
  if (::flock(port.value(), LOCK_EX | LOCK_NB) != 0) throw serial_busy_error(path);
  if (::ioctl(port.value(), TIOCEXCL) != 0) throw serial_open_error(path, errno);
  set_raw(path, port.value(), baud, speed);
  ask_for_low_latency(port.value());
  ::tcflush(port.value(), TCIFLUSH);
  return port.release();
}

/// PCs have device nodes for ports that do not exist. The kernel gives them the type 0, unknown.
bool is_built_in(const std::string& name) {
  std::ifstream file("/sys/class/tty/" + name + "/type");
  std::string type;
  return !(file >> type) || type != "0";
}

LinkLost lost(const std::string& path, std::string_view cause) {
  return {path, cause, "plug the vest in again, and see that it has power"};
}

}  // namespace

std::vector<std::string> serial_candidates(const std::filesystem::path& devices) {
  std::vector<std::string> candidates;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(devices, none)) {
    const std::string name = entry.path().filename();
    constexpr std::array<std::string_view, 4> kPrefixes{"ttyUSB", "ttyACM", "ttyAMA", "rfcomm"};
    const bool pluggable = std::any_of(kPrefixes.begin(), kPrefixes.end(),
                                       [&](std::string_view prefix) { return name.starts_with(prefix); });
    if (pluggable || (name.starts_with("ttyS") && is_built_in(name))) candidates.push_back(entry.path());
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

SerialPort::SerialPort(const std::string& path, std::uint32_t baud, milliseconds patience)
    : path_(path), patience_(patience), descriptor_(open_port(path, baud)) {}

SerialPort::~SerialPort() {
  // Plain closing would wait for half a minute.
  const auto deadline = steady_clock::now() + patience_;
  while (pending_bytes() > 0 && steady_clock::now() < deadline) ::poll(nullptr, 0, 1);
  if (pending_bytes() > 0) ::tcflush(descriptor_, TCOFLUSH);
  static_cast<void>(::ioctl(descriptor_, TIOCNXCL));
  ::close(descriptor_);
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  const auto deadline = steady_clock::now() + patience_;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      continue;
    }
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno != EAGAIN)
      throw lost(path_, fmt::format("the line is lost: {}", std::generic_category().message(errno)));
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
    if (left <= milliseconds(0))
      throw lost(path_, fmt::format("the line is lost: it does not take all bytes within {} ms", patience_.count()));
    pollfd line{.fd = descriptor_, .events = POLLOUT, .revents = 0};
    ::poll(&line, 1, static_cast<int>(left.count()));
  }
}

std::vector<std::uint8_t> SerialPort::read() {
  constexpr std::size_t kAtOnce_bytes = 65536;  // limits one call, because a line may never stop sending
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 4096> piece{};
  while (bytes.size() < kAtOnce_bytes) {
    const ssize_t count = ::read(descriptor_, piece.data(), piece.size());
    if (count > 0) {
      bytes.insert(bytes.end(), piece.begin(), piece.begin() + count);
      continue;
    }
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) break;
    // Return the bytes received before the line was lost. The next call reports the loss.
    if (!bytes.empty()) break;
    throw lost(path_, count == 0 ? "the line is lost: the other end hung up"
                                 : fmt::format("the line is lost: {}", std::generic_category().message(errno)));
  }
  return bytes;
}

bool SerialPort::wait_readable(milliseconds longest) const {
  const auto deadline = steady_clock::now() + longest;
  while (true) {
    const auto left = std::max(std::chrono::ceil<milliseconds>(deadline - steady_clock::now()), milliseconds(0));
    pollfd line{.fd = descriptor_, .events = POLLIN, .revents = 0};
    const int ready = ::poll(&line, 1, static_cast<int>(left.count()));
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

std::size_t SerialPort::pending_bytes() const {
  int pending = 0;
  return ::ioctl(descriptor_, TIOCOUTQ, &pending) == 0 && pending > 0 ? static_cast<std::size_t>(pending) : 0;
}

}  // namespace vestige
