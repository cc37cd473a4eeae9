// The outputs, each 0 (off) to 255 (on). The duty cycle is level / 256, but 1 at level 255. pins.c has six outputs on
// the microcontroller's own timers; with CHIPS, chips.c has 16 on each of that many PCA9685 chips.
#ifndef VESTIGE_FIRMWARE_PWM_H
#define VESTIGE_FIRMWARE_PWM_H

#include <stdbool.h>
#include <stdint.h>

// Number of PCA9685 chips, 1 to 4. 0: none, six motors on pins.
#ifndef CHIPS
#define CHIPS 0
#endif
#if CHIPS < 0 || CHIPS > 4
#error "CHIPS is the number of PCA9685 chips: 0 to 4"
#endif

enum { kActuators = CHIPS == 0 ? 6 : 16 * CHIPS };

// Starts with all outputs off.
void pwm_start(void);

// Call these only with interrupts off or from an interrupt, because the clock's interrupt switches outputs, too.
void pwm_set(uint8_t actuator, uint8_t level);
// After some calls of pwm_set(): the outputs take their levels.
void pwm_apply(void);
// All outputs are off at once, until all of them have the levels that were set since.
void pwm_cut(void);
// A millisecond has passed.
void pwm_tick(void);

// Whether outputs do not take their levels, or have not done so since pwm_clear_failure(): all were off meanwhile.
bool pwm_failed(void);
void pwm_clear_failure(void);

#endif
