// The serial line on USART0 (Arduino pins 0 and 1, and the USB socket), 8N1. Both directions use ring buffers that
// interrupts fill and empty.
#ifndef VESTIGE_FIRMWARE_UART_H
#define VESTIGE_FIRMWARE_UART_H

#include <stdbool.h>
#include <stdint.h>

void uart_start(void);

bool uart_has_byte(void);
// Precondition: uart_has_byte().
uint8_t uart_take_byte(void);

// Queues all bytes, or none if there is no room, so that commands never wait for answers.
bool uart_send(const uint8_t* bytes, uint8_t count);

// Whether bytes have been lost since uart_clear_overrun().
bool uart_overran(void);
void uart_clear_overrun(void);

#endif
