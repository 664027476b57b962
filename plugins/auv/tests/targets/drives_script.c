/* Drives that do what a script on standard input says, and tell all that comes of it.
 *
 *   h TIME ID EXTENDED DATA   hear a frame (DATA: hex, - for none)
 *   t TIME                    tick; tells "s ID DATA" of each frame said, and "o NUMBER NEWTONS" of each output
 *   f NUMBER FAILED           have a motor fail, or mend it
 *
 * Outputs that are no longer zero when they should be, and releases, are told as they come: "r".
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drives.h"
#include "outputs.h"

static bool failed[VEHICLE_THRUSTERS];
static double outputs[VEHICLE_THRUSTERS];

void outputs_set(unsigned thruster, double newtons)
{
    outputs[thruster] = newtons;
}

bool outputs_failed(unsigned thruster)
{
    return failed[thruster];
}

bool outputs_deep(bool told)
{
    return told;
}

void outputs_release(void)
{
    (void)printf("r\n");
}

int main(void)
{
    char line[128];
    static struct drives drives;
    static struct drives_frame said[VEHICLE_THRUSTERS];
    drives_begin(&drives);
    while (fgets(line, sizeof line, stdin) != NULL) {
        unsigned long now, id;
        unsigned extended, number;
        char data[24];
        if (sscanf(line, "h %lu %lx %u %20s", &now, &id, &extended, data) == 4) {
            struct drives_frame frame = {.id = (uint32_t)id, .extended = extended != 0u};
            frame.length = (uint8_t)(data[0] == '-' ? 0u : strlen(data) / 2u);
            for (size_t i = 0; i < frame.length; i++) {
                const char byte[3] = {data[2u * i], data[2u * i + 1u], '\0'};
                frame.data[i] = (uint8_t)strtoul(byte, NULL, 16);
            }
            drives_hear(&drives, &frame, (uint32_t)now);
        } else if (sscanf(line, "f %u %u", &number, &extended) == 2) {
            failed[number] = extended != 0u;
            continue;
        } else if (sscanf(line, "t %lu", &now) == 1) {
            const size_t count = drives_tick(&drives, (uint32_t)now, said);
            for (size_t i = 0; i < count; i++) {
                (void)printf("s %lx ", (unsigned long)said[i].id);
                for (size_t j = 0; j < said[i].length; j++) {
                    (void)printf("%02x", (unsigned)said[i].data[j]);
                }
                (void)printf("\n");
            }
        } else {
            return 1;
        }
        for (unsigned i = 0; i < VEHICLE_THRUSTERS; i++) {
            (void)printf("o %u %.17g\n", i, outputs[i]);
        }
        (void)printf(".\n");
    }
    return 0;
}
