// Six outputs, each 0 (off) to 255 (on), fast PWM of 976.6 Hz: level / 256 of the time, and all of it at 255.
#ifndef VESTIGE_FIRMWARE_PWM_H
#define VESTIGE_FIRMWARE_PWM_H

#include <stdint.h>

enum { kActuators = 6 };

// All off.
void pwm_start(void);

// Only while interrupts are off, or from one: the clock's interrupt switches outputs too.
void pwm_set(uint8_t actuator, uint8_t level);
void pwm_all_off(void);

#endif
