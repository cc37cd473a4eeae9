// What the actuators are told, for how long it holds, and when they go off by themselves.
#ifndef VESTIGE_FIRMWARE_ACTUATORS_H
#define VESTIGE_FIRMWARE_ACTUATORS_H

#include <stdbool.h>
#include <stdint.h>

// An eccentric mass starts slowly at a low duty: with KICK_START_MS each motor that starts from rest is fully on for
// that long first, 0 to 255 ms. 0: no kick.
#ifndef KICK_START_MS
#define KICK_START_MS 0
#endif

// All off, and the millisecond clock runs.
void actuators_start(void);

// Sets all of them: those from `count` on are off. They go off by themselves when `ttl_10ms` hundredths of a second
// pass without another call: never earlier, at most a millisecond later.
void actuators_set(const uint8_t* levels, uint8_t count, uint8_t ttl_10ms);
void actuators_off(void);

// Whether they have gone off by themselves, or the board has started, since actuators_clear_fail_safe().
bool actuators_failed_safe(void);
void actuators_clear_fail_safe(void);

// Whether the clock has ticked since the last question.
bool actuators_clock_ticked(void);

#endif
