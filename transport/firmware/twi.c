#include "twi.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/twi.h>

enum { kScl = _BV(PD0), kSda = _BV(PD1) };

static uint8_t receiver;  // address and direction
static const uint8_t* written;
static uint8_t left;

void twi_start(void) {
  TWSR = 0;                            // no prescaler
  TWBR = (F_CPU / 400000UL - 16) / 2;  // clock / (16 + 2 * TWBR)
  TWCR = _BV(TWEN);
}

void twi_stop(void) {
  TWCR = 0;
}

void twi_write(uint8_t address, const uint8_t* bytes, uint8_t count) {
  receiver = address << 1 | TW_WRITE;
  written = bytes;
  left = count;
  TWCR = _BV(TWINT) | _BV(TWSTA) | _BV(TWEN) | _BV(TWIE);
}

// The chips show what was written at the stop condition. It takes a few microseconds, but does not end while a line is
// held low.
static bool send_stop(void) {
  TWCR = _BV(TWINT) | _BV(TWSTO) | _BV(TWEN);
  for (uint8_t tries = 40; tries > 0; --tries) {
    if (!(TWCR & _BV(TWSTO))) return true;
  }
  return false;
}

ISR(TWI_vect) {
  switch (TW_STATUS) {
    case TW_START:
    case TW_REP_START:
      TWDR = receiver;
      break;
    case TW_MT_SLA_ACK:
    case TW_MT_DATA_ACK:
      if (left == 0) {
        twi_done(send_stop());
        return;
      }
      --left;
      TWDR = *written++;
      break;
    default:  // no acknowledgement, or another fault of the bus
      twi_done(false);
      return;
  }
  TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWIE);
}

// A line is pulled low as an output and released as an input; the bus's resistors pull it up.
static void release(uint8_t line) {
  DDRD &= ~line;
}
static void pull_low(uint8_t line) {
  PORTD &= ~line;
  DDRD |= line;
}

void twi_free_bus(uint8_t steps_left) {
  switch (steps_left) {
    case 3:
      pull_low(kScl);
      break;
    case 2:
      pull_low(kSda);
      break;
    case 1:
      release(kScl);
      break;
    case 0:
      release(kSda);  // while SCL is high: the stop condition
      break;
    default:
      // Only where needed: a byte that was cut short must not be completed.
      if (steps_left % 2 == 1 && !(PIND & kSda)) {
        pull_low(kScl);
      } else {
        release(kScl);
      }
  }
}
