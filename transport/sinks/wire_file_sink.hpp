#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "traces/files/output_file.hpp"
#include "transport/actuator_sink.hpp"

namespace vestige {

/// Writes frames as they would go to a board over the wire (`transport/wire/vest_frame.hpp`), one after another,
/// without times.
///
/// A file is complete or absent: it exists after `commit`. "-" (standard output), a device or a pipe gets each frame at
/// once, so that another program can pass it on.
class WireFileSink final : public ActuatorSink {
 public:
  /// `quantity` is the meaning of the levels. `ttl`, in 10 ms, is how long a board obeys a frame. Throws as
  /// `OutputFile` does.
  WireFileSink(const std::filesystem::path& path, Overwrite overwrite, Quantity quantity, std::uint8_t ttl);

  std::string name() const override { return file_.path().string(); }
  void send(const ActuatorFrame& frame, std::uint8_t sequence) override;
  void send_off(std::uint8_t sequence) override;
  std::uint64_t bytes_sent() const override { return bytes_sent_; }

  /// Call this when the stream has ended, by itself or by the user.
  void commit() { file_.commit(); }

 private:
  void write(std::span<const std::uint8_t> bytes);

  OutputFile file_;
  Quantity quantity_;
  std::uint8_t ttl_;
  std::uint64_t bytes_sent_ = 0;
};

}  // namespace vestige
