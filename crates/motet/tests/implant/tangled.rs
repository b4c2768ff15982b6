//! Hosts whose tets overlap: a device is refused where they do, with the place, and put in elsewhere.

use crate::common::Numbers;
use crate::common::devices::{room, small_ball};
use motet::base::{Error, Threads};
use motet::implant::{Device, Options, Report, implant};
use motet::mesh::Mesh;
use motet::mesh::history::{Changed, Rules};

fn put(host: &Mesh, device: Mesh) -> Result<Changed<Report>, Error> {
    let devices = [Device::new(device, "ball")];
    implant(host, &devices, &Options::default(), &Rules::default(), &Threads::single())
}

#[test]
fn a_device_where_tets_of_the_host_overlap_is_refused_with_the_place() {
    let (mut host, mut numbers) = (room(8), Numbers(5));
    let edge = 3.0 / 8.0;
    for p in host.points.iter_mut().filter(|p| p.iter().all(|x| x.abs() < 1.4)) {
        p.iter_mut().for_each(|x| *x += (2.0 * numbers.unit() - 1.0) * edge);
    }
    let refused = put(&host, small_ball(0.4, [0.1; 3])).unwrap_err();
    assert!(refused.what().contains("tets of the host overlap"), "{refused}");
    assert!(refused.place().is_some_and(|place| place.contains("the first facet at (")), "{refused}");
}

#[test]
fn a_host_whose_tets_overlap_elsewhere_takes_the_device() {
    let mut host = room(8);
    let vertex = host.points.iter().position(|p| *p == [-1.125; 3]).unwrap();
    host.points[vertex] = [-0.5; 3];
    let made = put(&host, small_ball(0.2, [0.8; 3])).unwrap();
    assert_eq!(made.report.devices[0].triangles, made.report.devices[0].triangles_kept);
}
