#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// Encodes one message of OSC 1.0 with liblo, whose own sending does not support IPv6, and uses the first address of a
/// name.
class OscMessageBuilder {
 public:
  OscMessageBuilder();

  OscMessageBuilder& add(float value);
  OscMessageBuilder& add(double value);
  OscMessageBuilder& add(std::int32_t value);
  OscMessageBuilder& add(const std::string& value);
  /// A boolean, which is a type without a value.
  OscMessageBuilder& add_switch(bool value);

  /// Returns the bytes of the message with this address.
  std::vector<std::byte> bytes(const std::string& address) const;

 private:
  struct Free {
    void operator()(void* message) const;
  };
  std::unique_ptr<void, Free> message_;
};

/// Packs messages, in order, into bundles to be executed at once. Each bundle fits into a network packet, unless one
/// message alone does not.
std::vector<std::vector<std::byte>> pack_osc(std::span<const std::vector<std::byte>> messages);

}  // namespace vestige
