// Six outputs, each 0 (off) to 255 (on), fast PWM of 976.6 Hz. The duty cycle is level / 256, but 1 at level 255.
#ifndef VESTIGE_FIRMWARE_PWM_H
#define VESTIGE_FIRMWARE_PWM_H

#include <stdint.h>

enum { kActuators = 6 };

// Starts with all outputs off.
void pwm_start(void);

// Call only with interrupts off or from an interrupt, because the clock's interrupt switches outputs, too.
void pwm_set(uint8_t actuator, uint8_t level);

#endif
