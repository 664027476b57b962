#include "drives.h"

#include <math.h>
#include <string.h>

#include "bus.h"
#include "outputs.h"

uint8_t drives_check(uint32_t id, const uint8_t *data, size_t length)
{
    uint8_t crc = 0xffu;
    for (size_t i = 0; i < length + 2u; i++) {
        const uint32_t byte = i < 2u ? (id >> (8u * i)) & 0xffu : data[i - 2u];
        crc = (uint8_t)(crc ^ byte);
        for (int bit = 0; bit < 8; bit++) {
            crc = (uint8_t)((crc & 0x80u) != 0u ? (crc << 1) ^ 0x1d : crc << 1);
        }
    }
    return (uint8_t)(crc ^ 0xffu);
}

static bool is_sound(const struct drives_frame *frame, uint8_t length)
{
    if (frame->length != length) {
        return false;
    }
    const size_t before = (size_t)length - 1u;
    return drives_check(frame->id, frame->data, before) == frame->data[before];
}

static void forget(struct drive *drive)
{
    drive->obeys = false;
    drive->counted = false;
    drive->enabled = false;
    drive->wanted = 0.0;
}

static void run_out(struct drive *drive, uint32_t now)
{
    if (drive->obeys && now - drive->heard_at >= VEHICLE_WATCHDOG) {
        forget(drive);
        drive->state = DRIVE_WATCHDOG;
    }
}

static void put_out(struct drive *drive, unsigned number)
{
    if (outputs_failed(number)) {
        drive->state = DRIVE_FAULT;
    } else if (drive->stopped) {
        drive->state = DRIVE_OFF;
    } else if (drive->obeys) {
        drive->state = drive->enabled ? DRIVE_RUNS : DRIVE_OFF;
    } else if (drive->state != DRIVE_WATCHDOG) {
        drive->state = DRIVE_OFF;
    }
    drive->thrust = drive->state == DRIVE_RUNS ? drive->wanted : 0.0;
    outputs_set(number, drive->thrust);
}

static void let_go(struct drives *drives)
{
    if (!drives->released) {
        drives->released = true;
        outputs_release();
    }
}

static void mind_dead_man(struct drives *drives, uint32_t now)
{
#if VEHICLE_DEAD_MAN > 0
    if (drives->commanded && now - drives->commanded_at >= VEHICLE_DEAD_MAN) {
        drives->commanded = false;
        drives->abandoned = true;
    }
#else
    (void)now;
#endif
    if (drives->abandoned && outputs_deep(drives->deep)) {
        let_go(drives);
    }
}

static void look_after(struct drives *drives, uint32_t now)
{
    mind_dead_man(drives, now);
    for (unsigned number = 0; number < VEHICLE_THRUSTERS; number++) {
        run_out(&drives->drive[number], now);
        put_out(&drives->drive[number], number);
    }
}

/* Return whether the command is valid. */
static bool obey(struct drive *drive, const struct vehicle_command *command, double most, uint32_t now)
{
    const uint8_t ahead = drive->counted ? (uint8_t)(command->counter - drive->last) : 0u;
    const bool valid = ahead >= 1u && ahead <= VEHICLE_MOST_AHEAD;
    if (valid || !drive->obeys) {
        drive->last = command->counter;
        drive->counted = true;
    }
    if (valid) {
        drive->obeys = true;
        drive->heard_at = now;
        drive->enabled = command->enable;
        drive->wanted = command->enable ? fmax(-most, fmin(most, command->thrust)) : 0.0;
    }
    return valid;
}

static void hear_command(
    struct drives *drives, unsigned number, const struct drives_frame *frame, uint32_t now)
{
    const struct vehicle_thruster *thruster = &vehicle_thrusters[number];
    struct drive *drive = &drives->drive[number];
    struct vehicle_command command;
    if (!is_sound(frame, thruster->command_length) || !thruster->take(frame->data, frame->length, &command)) {
        return;
    }
    if (command.raw < thruster->low || command.raw > thruster->high) {
        return;
    }
    if (obey(drive, &command, thruster->max_thrust, now)) {
        drives->commanded = true;
        drives->abandoned = false;
        drives->commanded_at = now;
    }
    put_out(drive, number);
}

static void hear_emergency(struct drives *drives, const struct drives_frame *frame)
{
    struct bus_emergency_t emergency;
    if (!is_sound(frame, BUS_EMERGENCY_LENGTH)
        || bus_emergency_unpack(&emergency, frame->data, frame->length) != 0
        || !bus_emergency_reason_is_in_range(emergency.reason)) {
        return;
    }
    for (unsigned number = 0; number < VEHICLE_THRUSTERS; number++) {
        drives->drive[number].stopped = true;
        put_out(&drives->drive[number], number);
    }
    if (emergency.release != 0u) {
        let_go(drives);
    }
}

static void hear_pressure(struct drives *drives, const struct drives_frame *frame)
{
    struct bus_pressure_t found;
    if (is_sound(frame, BUS_PRESSURE_LENGTH) && bus_pressure_unpack(&found, frame->data, frame->length) == 0
        && bus_pressure_temperature_is_in_range(found.temperature)) {
        drives->deep = bus_pressure_pressure_decode(found.pressure) > VEHICLE_DEEP;
    }
}

static void say_status(struct drive *drive, const struct vehicle_thruster *thruster, struct drives_frame *frame)
{
    const double watts = thruster->watts * pow(fabs(drive->thrust) / thruster->newtons, thruster->exponent);
    frame->id = thruster->status_id;
    frame->extended = false;
    frame->length = thruster->status_length;
    thruster->say(frame->data, drive->thrust, fmin(watts, VEHICLE_MOST_POWER), (uint8_t)drive->state,
                  drive->sequence);
    const size_t before = (size_t)frame->length - 1u;
    frame->data[before] = drives_check(frame->id, frame->data, before);
    drive->sequence++;
}

void drives_begin(struct drives *drives)
{
    memset(drives, 0, sizeof *drives);
    drives_quiet(drives);
}

void drives_quiet(struct drives *drives)
{
    for (unsigned number = 0; number < VEHICLE_THRUSTERS; number++) {
        forget(&drives->drive[number]);
        put_out(&drives->drive[number], number);
    }
}

void drives_hear(struct drives *drives, const struct drives_frame *frame, uint32_t now)
{
    look_after(drives, now);
    if (frame->extended) {
        return;
    }
    if (frame->id - BUS_EMERGENCY_FRAME_ID < VEHICLE_EMERGENCIES) {
        hear_emergency(drives, frame);
        return;
    }
    if (frame->id == BUS_PRESSURE_FRAME_ID) {
        hear_pressure(drives, frame);
        return;
    }
    for (unsigned number = 0; number < VEHICLE_THRUSTERS; number++) {
        if (frame->id == vehicle_thrusters[number].command_id) {
            hear_command(drives, number, frame, now);
            return;
        }
    }
}

size_t drives_tick(struct drives *drives, uint32_t now, struct drives_frame *frames)
{
    look_after(drives, now);
    const uint32_t late = now - drives->due;
    if (drives->told && late > UINT32_MAX / 2u) {
        return 0;
    }
    drives->due = (drives->told && late < VEHICLE_STATUS_PERIOD ? drives->due : now) + VEHICLE_STATUS_PERIOD;
    drives->told = true;
    for (unsigned number = 0; number < VEHICLE_THRUSTERS; number++) {
        say_status(&drives->drive[number], &vehicle_thrusters[number], &frames[number]);
    }
    return VEHICLE_THRUSTERS;
}
