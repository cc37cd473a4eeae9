// The vest's own program, for an Arduino MEGA (ATmega1280 or ATmega2560) with vibrators. README.md says how to wire and
// flash it.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "actuators.h"
#include "pwm.h"
#include "uart.h"
#include "wire.h"

// A pressure is not a duty: a board obeys the one that its actuators understand, and takes the other for an unknown
// frame.
#ifdef VALVES
#if KICK_START_MS > 0
#error "KICK_START_MS is for motors: a valve that is opened fully first gives too much"
#endif
enum { kLevels = 'P' };
#else
enum { kLevels = 'S' };
#endif

enum { kVersion = 1 };
enum { kFlagFailedSafe = 1, kFlagOverran = 2, kFlagOutputsFailed = 4 };

static uint8_t receive_errors_;

// Flags say what happened since the last answer; one that finds no room on the line takes nothing with it.
static uint8_t flags(void) {
  const bool outputs_failed = pwm_failed();  // an interrupt may change it
  return (actuators_failed_safe() || outputs_failed ? kFlagFailedSafe : 0) | (uart_overran() ? kFlagOverran : 0) |
         (outputs_failed ? kFlagOutputsFailed : 0);
}

static void answer(const uint8_t* bytes, uint8_t length, uint8_t reported) {
  uint8_t frame[kAnswerMax];
  if (!uart_send(frame, encode(bytes, length, frame))) return;
  if (reported & kFlagFailedSafe) actuators_clear_fail_safe();
  if (reported & kFlagOverran) uart_clear_overrun();
  if (reported & kFlagOutputsFailed) pwm_clear_failure();
}

static void acknowledge(uint8_t sequence) {
  const uint8_t reported = flags();
  const uint8_t bytes[] = {'A', sequence, reported, receive_errors_};
  answer(bytes, sizeof bytes, reported);
}

static void answer_hello(uint8_t sequence) {
  const uint8_t reported = flags();
  const uint8_t bytes[] = {'H', sequence, kVersion, kActuators, reported};
  answer(bytes, sizeof bytes, reported);
}

static void obey(const uint8_t* bytes, uint16_t length) {
  const uint8_t sequence = bytes[1];
  if (length >= 2 && bytes[0] == 'X') {  // whatever follows: stopping is never wrong
    actuators_off();
    acknowledge(sequence);
  } else if (length == 2 && bytes[0] == 'H') {
    answer_hello(sequence);
  } else if (length >= 4 && bytes[0] == kLevels && length == 4 + (uint16_t)bytes[3]) {
    actuators_set(bytes + 4, bytes[3], bytes[2]);
    acknowledge(sequence);
  } else {
    ++receive_errors_;
  }
}

static void take(uint8_t byte) {
  const Received received = receive(byte);
  if (received == kFrame) obey(payload(), payload_length());
  if (received == kDamaged) ++receive_errors_;
}

int main(void) {
  wdt_enable(WDTO_250MS);  // first: where it has restarted the board, it runs already, with 16 ms
  actuators_start();
  uart_start();
  set_sleep_mode(SLEEP_MODE_IDLE);
  sei();
  while (1) {
    if (uart_has_byte()) take(uart_take_byte());
    // Fed only while the clock runs, on which the fail-safe depends: otherwise the board restarts, off.
    if (actuators_clock_ticked()) wdt_reset();
    cli();
    if (uart_has_byte()) {
      sei();
    } else {
      sleep_enable();
      sei();  // takes effect after the next instruction: nothing can come between
      sleep_cpu();
      sleep_disable();
    }
  }
}
