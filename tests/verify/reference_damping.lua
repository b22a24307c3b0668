-- reference_damping.lua - what the dampings are compared with, computed independently of Talus: the exact
-- discrete solution of the central difference with viscous damping; closed forms of one degree of freedom
-- with local damping and with an ideal servo. Angles in radians, SI units.
return {
    viscous = {
        { id = "P.viscous.1", omega = 10, alpha = 1, dt = 0.01, amp_per_step = 0.995012437733208,
            phase_per_step = 0.09991710316798935, period_steps = 62.883981900633636,
            velocity_ratio = 0.9900497512437813, terminal = 10 },
        { id = "P.viscous.2", omega = 223.60679774997897, alpha = 44.721359549995796,
            dt = 0.0004, amp_per_step = 0.9910953726978168, phase_per_step = 0.08902554893174072,
            period_steps = 70.57732732428467, velocity_ratio = 0.9822700377830244,
            terminal = 0.22360679774997896 },
    },
    ["local"] = {
        { id = "P.local.0.1", alpha = 0.1, half_cycle_ratio = 0.9045340337332909,
            half_cycle_time_x_omega = 3.1534602438893446, free_fall_acceleration_factor = 0.9,
            time_step_reduction = 0.9534625892455922 },
        { id = "P.local.0.3", alpha = 0.3, half_cycle_ratio = 0.7337993857053428,
            half_cycle_time_x_omega = 3.2551402243361265, free_fall_acceleration_factor = 0.7,
            time_step_reduction = 0.8770580193070292 },
        { id = "P.local.0.5", alpha = 0.5, half_cycle_ratio = 0.5773502691896257,
            half_cycle_time_x_omega = 3.503991299241047, free_fall_acceleration_factor = 0.5,
            time_step_reduction = 0.8164965809277261 },
        { id = "P.local.0.8", alpha = 0.8, half_cycle_ratio = 0.33333333333333326,
            half_cycle_time_x_omega = 4.683209820693818,
            free_fall_acceleration_factor = 0.19999999999999996,
            time_step_reduction = 0.7453559924999299 },
    },
    adaptive = {
        { id = "P.adaptive.0.3", target = 0.3, half_cycle_ratio = 0.7337993857053428,
            half_cycle_time_x_omega = 3.1052058661033826,
            free_fall_acceleration_factor = 0.7692307692307692, free_fall_alpha_times_t = 0.3 },
        { id = "P.adaptive.0.5", target = 0.5, half_cycle_ratio = 0.5773502691896257,
            half_cycle_time_x_omega = 3.034545479782387,
            free_fall_acceleration_factor = 0.6666666666666666, free_fall_alpha_times_t = 0.5 },
        { id = "P.adaptive.0.8", target = 0.8, half_cycle_ratio = 0.33333333333333326,
            half_cycle_time_x_omega = 2.8099258924162904,
            free_fall_acceleration_factor = 0.5555555555555556, free_fall_alpha_times_t = 0.8 },
    },
}
