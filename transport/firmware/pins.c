// Six outputs on timers 4 and 5: three each, pins 3, 4, 5 of ports H and L. Fast PWM of 976.6 Hz.
#include <avr/io.h>

#include "pwm.h"

typedef struct {
  volatile uint16_t* compare;
  volatile uint8_t* control;
  volatile uint8_t* port;
  uint8_t connected;  // in `control`: the pin follows the timer
  uint8_t pin;
} Output;

static const Output kOutputs[kActuators] = {
    {&OCR4A, &TCCR4A, &PORTH, _BV(COM4A1), _BV(PH3)},  // Arduino pin 6
    {&OCR4B, &TCCR4A, &PORTH, _BV(COM4B1), _BV(PH4)},  // 7
    {&OCR4C, &TCCR4A, &PORTH, _BV(COM4C1), _BV(PH5)},  // 8
    {&OCR5A, &TCCR5A, &PORTL, _BV(COM5A1), _BV(PL3)},  // 46
    {&OCR5B, &TCCR5A, &PORTL, _BV(COM5B1), _BV(PL4)},  // 45
    {&OCR5C, &TCCR5A, &PORTL, _BV(COM5C1), _BV(PL5)},  // 44
};

void pwm_start(void) {
  PORTH = 0;
  PORTL = 0;
  DDRH = _BV(PH3) | _BV(PH4) | _BV(PH5);
  DDRL = _BV(PL3) | _BV(PL4) | _BV(PL5);
  // Fast PWM, 8 bits, clock / 64. No output is connected yet.
  TCCR4A = _BV(WGM40);
  TCCR5A = _BV(WGM50);
  TCCR4B = _BV(WGM42) | _BV(CS41) | _BV(CS40);
  TCCR5B = _BV(WGM52) | _BV(CS51) | _BV(CS50);
}

void pwm_set(uint8_t actuator, uint8_t level) {
  const Output* output = &kOutputs[actuator];
  // A compare value of 0 would still give one tick, and none gives all 256: both ends are the port's.
  if (level == 0 || level == 255) {
    if (level == 0) {
      *output->port &= ~output->pin;
    } else {
      *output->port |= output->pin;
    }
    *output->control &= ~output->connected;
  } else {
    *output->compare = level - 1;  // high from 0 to and with the compare value
    *output->control |= output->connected;
  }
}

// A pin takes its level at once, and cannot fail.
void pwm_apply(void) {}
void pwm_cut(void) {}
void pwm_tick(void) {}
bool pwm_failed(void) {
  return false;
}
void pwm_clear_failure(void) {}
