/* The drives of a vehicle's thrusters: they obey valid commands only, and stop thrusters by themselves.
 *
 * Nothing here reads clocks, waits, blocks or allocates. Times are microseconds of any 32-bit counter, which
 * may run over. One thread at a time may call these functions: guard them where an interrupt hears frames.
 */
#ifndef DRIVES_H
#define DRIVES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vehicle.h"

/* A data frame of classic CAN. */
struct drives_frame {
    uint32_t id;
    bool extended;
    uint8_t length; /* 0 to 8 */
    uint8_t data[8];
};

/* As ThrusterStatus says it. */
enum drive_state { DRIVE_OFF = 0, DRIVE_RUNS = 1, DRIVE_WATCHDOG = 2, DRIVE_FAULT = 3 };

/* One drive. It sets thrust, newtons, and state; all else is its own. */
struct drive {
    double thrust;
    enum drive_state state;
    bool stopped; /* by an emergency, which nothing undoes */
    bool counted; /* whether last is a counter that was heard */
    uint8_t last;
    bool obeys; /* whether a valid command came, and the watchdog has not run out since */
    uint32_t heard_at;
    bool enabled;
    double wanted;
    uint8_t sequence; /* of its next status */
};

struct drives {
    struct drive drive[VEHICLE_THRUSTERS];
    bool released;
    bool deep; /* as pressure said last */
    bool commanded; /* whether a valid command came, and the dead man's time has not run out since */
    bool abandoned; /* whether it ran out */
    uint32_t commanded_at;
    bool told; /* whether due counts */
    uint32_t due;
};

/* Begin: all is off, and no command is known. */
void drives_begin(struct drives *drives);

/* Take a frame of the bus, at its time. */
void drives_hear(struct drives *drives, const struct drives_frame *frame, uint32_t now);

/* Do what is due; write at most VEHICLE_THRUSTERS frames that are to be sent, and return how many.
 * To be called often: watchdogs are as exact as the time from one call to the next. */
size_t drives_tick(struct drives *drives, uint32_t now, struct drives_frame *frames);

/* Set all outputs to zero, and obey nothing before a counter is known again. */
void drives_quiet(struct drives *drives);

/* The check of a message: CRC-8 SAE J1850 over its identifier, low byte first, and bytes of data. */
uint8_t drives_check(uint32_t id, const uint8_t *data, size_t length);

#endif
