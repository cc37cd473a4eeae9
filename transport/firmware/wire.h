// Frames on the wire: COBS(payload, CRC low byte, CRC high byte) and one 0x00. README.md lists the payloads.
#ifndef VESTIGE_FIRMWARE_WIRE_H
#define VESTIGE_FIRMWARE_WIRE_H

#include <stdint.h>

enum {
  kPayloadMax = 4 + 255,                  // type, sequence, ttl, n, n levels
  kAnswerPayloadMax = 5,                  // 'H', sequence, version, n, flags
  kAnswerMax = kAnswerPayloadMax + 2 + 2  // with CRC, COBS code and delimiter
};

typedef enum { kNothing, kFrame, kDamaged } Received;

// Takes one byte of the line. kFrame: a frame is complete, and `payload()` and `payload_length()` return its content
// until the next byte is taken. kDamaged: an invalid frame is complete. A lone delimiter is kNothing.
Received receive(uint8_t byte);
const uint8_t* payload(void);
uint16_t payload_length(void);

// Encodes `length` bytes, at most kAnswerPayloadMax, into `frame`, which has room for kAnswerMax bytes. Returns the
// size of the frame.
uint8_t encode(const uint8_t* bytes, uint8_t length, uint8_t* frame);

#endif
