//! FMU states as bytes (FMI 2.0 section 2.1.8).
//!
//! Layout, little endian: magic (8 bytes), format version (4), length of the GUID (4), GUID,
//! length of the payload (8), payload, CRC-32 of all that precedes (4). The payload is the
//! snapshot in postcard's format. The GUID ties the bytes to one model description.

use serde::{Serialize, de::DeserializeOwned};

const MAGIC: [u8; 8] = *b"FMI2STAT";
const VERSION: u32 = 1;

/// Why bytes are no state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum StateBytesError {
    #[error("the bytes are no FMU state")]
    Foreign,
    #[error("the state was written in another format version")]
    Version,
    #[error("the state belongs to another model description (GUID)")]
    Guid,
    #[error("the state has the wrong length")]
    Length,
    #[error("the state's checksum is wrong")]
    Checksum,
    #[error("the state's content cannot be read")]
    Content,
}

/// Writes `snapshot` of the model with `guid`.
pub fn write<S: Serialize>(guid: &str, snapshot: &S) -> Result<Vec<u8>, StateBytesError> {
    let payload = postcard::to_stdvec(snapshot).map_err(|_| StateBytesError::Content)?;
    let guid_length = u32::try_from(guid.len()).map_err(|_| StateBytesError::Length)?;
    let mut bytes = Vec::with_capacity(payload.len() + guid.len() + 28);
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(guid_length.to_le_bytes());
    bytes.extend(guid.as_bytes());
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(payload);
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    Ok(bytes)
}

/// Reads what [`write`] wrote for the same GUID.
pub fn read<S: DeserializeOwned>(guid: &str, bytes: &[u8]) -> Result<S, StateBytesError> {
    let mut rest = bytes;
    if take(&mut rest)? != MAGIC {
        return Err(StateBytesError::Foreign);
    }
    if u32::from_le_bytes(take(&mut rest)?) != VERSION {
        return Err(StateBytesError::Version);
    }
    let guid_length = u32::from_le_bytes(take(&mut rest)?) as usize;
    if rest.split_off(..guid_length).ok_or(StateBytesError::Length)? != guid.as_bytes() {
        return Err(StateBytesError::Guid);
    }
    let length = usize::try_from(u64::from_le_bytes(take(&mut rest)?)).map_err(|_| StateBytesError::Length)?;
    let payload = rest.split_off(..length).ok_or(StateBytesError::Length)?;
    let checksum = u32::from_le_bytes(take(&mut rest)?);
    if !rest.is_empty() {
        return Err(StateBytesError::Length);
    }
    if crc32fast::hash(&bytes[..bytes.len() - 4]) != checksum {
        return Err(StateBytesError::Checksum);
    }
    match postcard::take_from_bytes(payload) {
        Ok((snapshot, [])) => Ok(snapshot),
        _ => Err(StateBytesError::Content),
    }
}

fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], StateBytesError> {
    let (head, tail) = rest.split_first_chunk::<N>().ok_or(StateBytesError::Length)?;
    *rest = tail;
    Ok(*head)
}
