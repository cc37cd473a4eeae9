#include "uart.h"

#ifndef BAUD
#define BAUD 57600UL
#endif

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/setbaud.h>

// Indices of the receive ring wrap with their type; it holds nine frames for six motors, or one of the longest.
static volatile uint8_t received[256];
static volatile uint8_t received_begin, received_end;
static volatile bool overran;

enum { kSendingSize = 64 };  // a power of two
static volatile uint8_t sending[kSendingSize];
static volatile uint8_t sending_begin, sending_end;

void uart_start(void) {
#if USE_2X
  UCSR0A = _BV(U2X0);
#else
  UCSR0A = 0;
#endif
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UBRR0H = UBRRH_VALUE;
  UBRR0L = UBRRL_VALUE;
  UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

ISR(USART0_RX_vect) {
  if (UCSR0A & _BV(DOR0)) overran = true;  // the flag is gone once the byte is read
  const uint8_t byte = UDR0;               // damaged ones too: the checksum refuses their frame
  const uint8_t next = received_end + 1;
  if (next == received_begin) {
    overran = true;
    return;
  }
  received[received_end] = byte;
  received_end = next;
}

bool uart_has_byte(void) {
  return received_begin != received_end;
}

uint8_t uart_take_byte(void) {
  const uint8_t byte = received[received_begin];
  ++received_begin;
  return byte;
}

ISR(USART0_UDRE_vect) {
  if (sending_begin == sending_end) {
    UCSR0B &= ~_BV(UDRIE0);
    return;
  }
  UDR0 = sending[sending_begin % kSendingSize];
  ++sending_begin;
}

bool uart_send(const uint8_t* bytes, uint8_t count) {
  const uint8_t queued = sending_end - sending_begin;
  if (count > kSendingSize - queued) return false;
  while (count-- > 0) {
    sending[sending_end % kSendingSize] = *bytes++;
    ++sending_end;
  }
  cli();  // the interrupt switches the same register
  UCSR0B |= _BV(UDRIE0);
  sei();
  return true;
}

bool uart_overran(void) {
  return overran;
}

void uart_clear_overrun(void) {
  overran = false;
}
