// The outputs of PCA9685 chips: 12-bit PWM, 16 channels each, on the two-wire bus. Source: NXP, PCA9685 data sheet,
// revision 4, section 7.3 (registers).
//
// The chips keep their outputs when this microcontroller restarts. So all their OE pins hang on one of its pins, and a
// resistor pulls them high, which is off: in reset, and whenever the chips may hold levels that nobody asks for any
// more.
#include <avr/io.h>
#include <util/atomic.h>

#include "pwm.h"
#include "twi.h"

enum { kFirstAddress = 0x40, kChannels = 16, kBytesPerChannel = 4 };
enum { kOutputsOff = _BV(PD2) };  // Arduino pin 19: OE of all chips, which is active low

// Registers, and what they are set to.
enum { kMode1 = 0x00, kMode2 = 0x01, kFirstChannel = 0x06, kAllOffHigh = 0xFD, kPrescale = 0xFE };
enum { kAutoIncrement = 0x20, kSleep = 0x10 };  // MODE1
enum { kTotemPole = 0x04 };  // MODE2; with the rest 0, OE high makes outputs low, and stop conditions show new levels
enum { kFull = 0x10 };       // in a channel's high bytes: on or off all the time
enum { kFrequency = 5 };     // 25 MHz / 4096 / (5 + 1) = 1017 Hz

static const uint8_t kSetUp[][2] = {{kAllOffHigh, kFull},
                                    {kMode1, kSleep | kAutoIncrement},  // the frequency can be set only in sleep
                                    {kMode2, kTotemPole},
                                    {kPrescale, kFrequency},
                                    {kMode1, kAutoIncrement}};
enum { kSetUpSteps = sizeof kSetUp / sizeof *kSetUp };

typedef enum {
  kFreeing,    // the bus is being freed: at the start, and after a fault
  kSettingUp,  // each chip in turn
  kWaking,     // the chips' oscillators start
  kWriting,    // levels, each chip in turn
  kIdle        // the chips hold the levels that are asked for
} Stage;

// Until the next step of a stage that waits; in a stage that writes, until the bus hangs: a message takes less than
// 2 ms. The millisecond that runs has begun already.
enum { kWaking_ms = 1 + 1, kMessage_ms = 3 + 1 };

static uint8_t levels[kActuators];
static bool changed;  // `levels`, since the chips were written last or are being written now
static bool cut;      // pwm_cut() was called since then
static volatile bool failed;
static Stage stage;
static uint8_t left_ms;
static uint8_t chip;
static uint8_t step;  // of the chip's setting up
static uint8_t message[1 + kChannels * kBytesPerChannel];

// Channels of a chip switch on one after the other, so that the motors' supply is not loaded by all at once.
static void describe(uint8_t channel, uint8_t level, uint8_t* registers) {
  const uint16_t on = channel * (4096 / kChannels);
  const uint16_t off = (on + level * 16) % 4096;
  registers[0] = on & 0xFF;
  registers[1] = on >> 8 | (level == 255 ? kFull : 0);
  registers[2] = off & 0xFF;
  registers[3] = off >> 8 | (level == 0 ? kFull : 0);
}

static void write_chip(const uint8_t* bytes, uint8_t count) {
  left_ms = kMessage_ms;
  twi_write(kFirstAddress + chip, bytes, count);
}

static void write_levels(void) {
  message[0] = kFirstChannel;
  for (uint8_t i = 0; i < kChannels; ++i) {
    describe(i, levels[chip * kChannels + i], message + 1 + i * kBytesPerChannel);
  }
  write_chip(message, sizeof message);
}

static void begin_writing(void) {
  stage = kWriting;
  changed = false;
  cut = false;
  chip = 0;
  write_levels();
}

static void begin_setting_up(void) {
  stage = kSettingUp;
  twi_start();
  chip = 0;
  step = 0;
  write_chip(kSetUp[0], sizeof kSetUp[0]);
}

static void begin_freeing(void) {
  twi_stop();
  stage = kFreeing;
  left_ms = kFreeingSteps + 1;
}

static void fail(void) {
  PORTD |= kOutputsOff;
  failed = true;
  begin_freeing();
}

static void go_on_setting_up(void) {
  if (++step == kSetUpSteps) {
    step = 0;
    ++chip;
  }
  if (chip < CHIPS) {
    write_chip(kSetUp[step], sizeof kSetUp[step]);
  } else {
    stage = kWaking;
    left_ms = kWaking_ms;
  }
}

static void go_on_writing(void) {
  if (++chip < CHIPS) {
    write_levels();
    return;
  }
  if (!cut) PORTD &= ~kOutputsOff;
  stage = kIdle;
  left_ms = 0;
  pwm_apply();
}

void twi_done(bool acknowledged) {
  if (!acknowledged) {
    fail();
  } else if (stage == kSettingUp) {
    go_on_setting_up();
  } else {
    go_on_writing();
  }
}

void pwm_start(void) {
  PORTD |= kOutputsOff;  // before the pin becomes an output
  DDRD |= kOutputsOff;
  begin_freeing();
}

void pwm_set(uint8_t actuator, uint8_t level) {
  levels[actuator] = level;
  changed = true;
}

void pwm_apply(void) {
  if (stage == kIdle && changed) begin_writing();
}

void pwm_cut(void) {
  PORTD |= kOutputsOff;
  cut = true;
}

void pwm_tick(void) {
  pwm_apply();
  if (left_ms == 0) return;
  --left_ms;
  if (stage == kFreeing && left_ms > 0) twi_free_bus(left_ms - 1);
  if (left_ms > 0) return;
  if (stage == kFreeing) {
    begin_setting_up();
  } else if (stage == kWaking) {
    begin_writing();
  } else {
    fail();
  }
}

bool pwm_failed(void) {
  return failed;
}

void pwm_clear_failure(void) {
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    if (!(PORTD & kOutputsOff)) failed = false;
  }
}
