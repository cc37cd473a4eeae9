#include "wire.h"

#include <stdbool.h>
#include <util/crc16.h>

static uint8_t decoded[kPayloadMax + 2];  // payload and CRC
static uint16_t decoded_length;
static uint8_t block_left;  // bytes until the next COBS code
static bool zero_follows;   // the block stands for its bytes and a zero, unless the frame ends with it
static bool too_long;

// CRC-16/CCITT-FALSE: polynomial 0x1021, unreflected, no final xor. avr-libc calls the polynomial XMODEM's.
static uint16_t checksum(const uint8_t* bytes, uint16_t length) {
  uint16_t crc = 0xFFFF;
  while (length-- > 0) crc = _crc_xmodem_update(crc, *bytes++);
  return crc;
}

static void append(uint8_t byte) {
  if (decoded_length < sizeof decoded) {
    decoded[decoded_length++] = byte;
  } else {
    too_long = true;
  }
}

static Received end_of_frame(void) {
  if (decoded_length == 0 && block_left == 0) return kNothing;
  if (too_long || block_left != 0 || decoded_length < 3) return kDamaged;
  const uint16_t crc = checksum(decoded, payload_length());
  const bool right = decoded[decoded_length - 2] == (crc & 0xFF) && decoded[decoded_length - 1] == crc >> 8;
  return right ? kFrame : kDamaged;
}

Received receive(uint8_t byte) {
  static bool started;
  if (!started) {
    decoded_length = 0;
    block_left = 0;
    zero_follows = false;
    too_long = false;
    started = true;
  }
  if (byte == 0) {
    started = false;
    return end_of_frame();
  }
  if (block_left > 0) {
    append(byte);
    --block_left;
  } else {
    if (zero_follows) append(0);
    block_left = byte - 1;
    zero_follows = byte != 0xFF;
  }
  return kNothing;
}

const uint8_t* payload(void) {
  return decoded;
}

uint16_t payload_length(void) {
  return decoded_length - 2;
}

uint8_t encode(const uint8_t* bytes, uint8_t length, uint8_t* frame) {
  const uint16_t crc = checksum(bytes, length);
  const uint8_t whole = length + 2;
  uint8_t code_at = 0;
  uint8_t size = 1;
  for (uint8_t i = 0; i < whole; ++i) {
    const uint8_t byte = i < length ? bytes[i] : i == length ? crc : crc >> 8;
    if (byte == 0) {
      frame[code_at] = size - code_at;
      code_at = size++;
    } else {
      frame[size++] = byte;
    }
  }
  frame[code_at] = size - code_at;
  frame[size++] = 0;
  return size;
}
