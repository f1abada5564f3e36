//! Measured rows of the slow cyclic test.

use super::{FootingRow, RockingPacket};
use crate::table;

/// Packets a to e of the measured rows.
pub fn measured_packets() -> Vec<RockingPacket> {
    let table = table("rocking/ssg02_03_slow.csv");
    let rows = table.rows([
        "normalized_shear",
        "normalized_moment",
        "normalized_settlement",
        "normalized_sliding",
        "rotation_rad",
    ]);
    let mut packets: Vec<RockingPacket> = Vec::new();
    for (name, [shear, moment, settlement, sliding, rotation]) in
        table.text("packet").into_iter().zip(rows)
    {
        if packets.last().is_none_or(|packet| packet.name != name) {
            packets.push(RockingPacket { name: name.to_owned(), rows: Vec::new() });
        }
        if let Some(packet) = packets.last_mut() {
            packet.rows.push(FootingRow { shear, moment, settlement, sliding, rotation });
        }
    }
    packets
}
