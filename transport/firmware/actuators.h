// The levels of the actuators, how long they hold, and when the actuators switch off by themselves.
#ifndef VESTIGE_FIRMWARE_ACTUATORS_H
#define VESTIGE_FIRMWARE_ACTUATORS_H

#include <stdbool.h>
#include <stdint.h>

// An eccentric mass starts slowly at a low duty. With KICK_START_MS, each motor that starts from rest is first fully on
// for that time, 0 to 255 ms. 0: no kick.
#ifndef KICK_START_MS
#define KICK_START_MS 0
#endif

// Switches all actuators off and starts the millisecond clock.
void actuators_start(void);

// Sets all actuators; those from `count` on are off. They switch off by themselves after `ttl_10ms` hundredths of a
// second without another call: never earlier, at most a millisecond later.
void actuators_set(const uint8_t* levels, uint8_t count, uint8_t ttl_10ms);
void actuators_off(void);

// Whether the actuators have switched off by themselves, or the board has started, since actuators_clear_fail_safe().
bool actuators_failed_safe(void);
void actuators_clear_fail_safe(void);

// Whether the clock has ticked since the last call.
bool actuators_clock_ticked(void);

#endif
