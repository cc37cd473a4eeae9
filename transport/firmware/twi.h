// The two-wire bus (TWI, I2C) at 400 kHz, as its only master, by interrupts. SCL is PD0 (Arduino pin 21), SDA PD1 (20).
// Nothing here waits longer than a few microseconds; the caller measures the time.
#ifndef VESTIGE_FIRMWARE_TWI_H
#define VESTIGE_FIRMWARE_TWI_H

#include <stdbool.h>
#include <stdint.h>

void twi_start(void);
// Gives both lines up, whatever was on its way.
void twi_stop(void);

// Begins to write `count` bytes, at least 1, to the chip with this address of seven bits. They stay unchanged until
// twi_done() is called; that never happens if the bus hangs.
void twi_write(uint8_t address, const uint8_t* bytes, uint8_t count);
// The caller's own: all bytes were acknowledged and the bus is free again, or the write has failed. Called from the
// bus's interrupt.
void twi_done(bool acknowledged);

// A chip that was interrupted may hold SDA low until it gets another clock. With the bus stopped, call this once a
// millisecond, with kFreeingSteps - 1 first and 0 last: clocks until SDA is free, then a stop condition.
enum { kFreeingSteps = 24 };
void twi_free_bus(uint8_t steps_left);

#endif
