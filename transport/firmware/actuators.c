#include "actuators.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>

#include "pwm.h"

static volatile uint16_t left_ms;  // until they go off by themselves; 0: they are off
static volatile bool failed_safe;
static volatile bool ticked;

#if KICK_START_MS > 0
static uint8_t asked[kActuators];
static uint8_t kick_left_ms[kActuators];

static void start_or_set(uint8_t actuator, uint8_t level) {
  if (level == 0) {
    kick_left_ms[actuator] = 0;
  } else if (asked[actuator] == 0) {
    kick_left_ms[actuator] = KICK_START_MS;
  }
  asked[actuator] = level;
  pwm_set(actuator, kick_left_ms[actuator] > 0 ? 255 : level);
}

static void end_kicks(void) {
  for (uint8_t i = 0; i < kActuators; ++i) {
    if (kick_left_ms[i] > 0 && --kick_left_ms[i] == 0) pwm_set(i, asked[i]);
  }
}
#else
static void start_or_set(uint8_t actuator, uint8_t level) {
  pwm_set(actuator, level);
}
static void end_kicks(void) {}
#endif

static void all_off(void) {
  left_ms = 0;
  pwm_cut();
  for (uint8_t i = 0; i < kActuators; ++i) start_or_set(i, 0);
  pwm_apply();
}

void actuators_start(void) {
  pwm_start();
  failed_safe = true;
  // Timer 0 counts to 249 at clock / 64: 1 ms at 16 MHz.
  TCCR0A = _BV(WGM01);
  OCR0A = F_CPU / 64 / 1000 - 1;
  TIMSK0 = _BV(OCIE0A);
  TCCR0B = _BV(CS01) | _BV(CS00);
}

ISR(TIMER0_COMPA_vect) {
  ticked = true;
  if (left_ms > 0 && --left_ms == 0) {
    all_off();
    failed_safe = true;
  }
  end_kicks();
  pwm_tick();
}

void actuators_set(const uint8_t* levels, uint8_t count, uint8_t ttl_10ms) {
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    for (uint8_t i = 0; i < kActuators; ++i) start_or_set(i, i < count ? levels[i] : 0);
    pwm_apply();
    left_ms = ttl_10ms * 10 + 1;  // the millisecond that runs has begun already
  }
}

void actuators_off(void) {
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    all_off();
  }
}

bool actuators_failed_safe(void) {
  return failed_safe;
}

void actuators_clear_fail_safe(void) {
  failed_safe = false;
}

bool actuators_clock_ticked(void) {
  const bool since = ticked;
  ticked = false;
  return since;
}
