#include "transport/sinks/frame_file_sink.hpp"

#include "transport/wire/vest_frame.hpp"

namespace vestige {

FrameFileSink::FrameFileSink(const std::filesystem::path& path, Overwrite overwrite, Quantity quantity,
                             std::uint8_t ttl)
    : file_(path, overwrite), quantity_(quantity), ttl_(ttl) {}

void FrameFileSink::send(const ActuatorFrame& frame, std::uint8_t sequence) {
  write(encode_state(quantity_, frame.duty, sequence, ttl_));
}

void FrameFileSink::send_off(std::uint8_t sequence) {
  write(encode_off(sequence));
}

void FrameFileSink::write(std::span<const std::uint8_t> bytes) {
  file_.write(std::as_bytes(bytes));
  file_.flush();
  bytes_sent_ += bytes.size();
}

}  // namespace vestige
