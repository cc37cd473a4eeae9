#include "transport/sinks/wire_file_sink.hpp"

#include "transport/wire/vest_frame.hpp"

namespace vestige {

WireFileSink::WireFileSink(const std::filesystem::path& path, Overwrite overwrite, Quantity quantity, std::uint8_t ttl)
    : file_(path, overwrite), quantity_(quantity), ttl_(ttl) {}

void WireFileSink::send(const ActuatorFrame& frame, std::uint8_t sequence) {
  write(encode_state(quantity_, frame.duty, sequence, ttl_));
}

void WireFileSink::send_off(std::uint8_t sequence) {
  write(encode_off(sequence));
}

void WireFileSink::write(std::span<const std::uint8_t> bytes) {
  file_.write(std::as_bytes(bytes));
  file_.flush();
  bytes_sent_ += bytes.size();
}

}  // namespace vestige
